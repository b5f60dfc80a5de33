// SPDX-License-Identifier: MIT
// Group [query]: occlusion queries. Render thread.
#pragma once

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class QueryCommands {
public:
    /// `execution` outlives it.
    explicit QueryCommands(Execution& execution) : execution_(execution) {}

    void QueryResult(RequestId request, ClientName query);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
