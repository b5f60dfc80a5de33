// SPDX-License-Identifier: MIT
// Group [object]: what all kinds of objects have. Render thread.
#pragma once

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class ObjectCommands {
public:
    /// `execution` outlives it.
    explicit ObjectCommands(Execution& execution) : execution_(execution) {}

    void ObjectDelete(ClientName object) {
        execution_.session.objects.erase(object);
        execution_.targets_known = false;
    }

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
