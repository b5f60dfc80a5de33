// SPDX-License-Identifier: MIT
// Group [format]: what the driver says of internal formats. Render thread.
#pragma once

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class FormatCommands {
public:
    /// `execution` outlives it.
    explicit FormatCommands(Execution& execution) : execution_(execution) {}

    void FormatQuery(RequestId request, GLenum target, GLenum internal_format);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
