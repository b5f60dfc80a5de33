// SPDX-License-Identifier: MIT
#include "tileserver/execute/dispatch_commands.h"

#include <algorithm>
#include <array>

#include "common/wire/limits.h"
#include "tileserver/session/shader_memory.h"

namespace wall::tileserver {

void DispatchCommands::Dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (block_.in_begin) return execution_.refuse("between Begin and End");
    if (!block_.draws) return;
    std::uint64_t invocations = 0;
    for_each_program(execution_.session, execution_.context->state,
                     [&](const Program& program) { invocations = std::max(invocations, program.group_invocations()); });
    if (invocations == 0) return;
    for (const std::uint64_t groups : std::array{x, y, z}) {
        if (groups == 0) return;
        if (groups > wire::kMostInvocations / invocations) return execution_.refuse("too many invocations");
        invocations *= groups;
    }
    execution_.gl.DispatchCompute(x, y, z);
}

}  // namespace wall::tileserver
