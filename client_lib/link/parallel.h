// SPDX-License-Identifier: MIT
// Being one process of a parallel program: several that draw into the same windows (docs/parallel-programs.md). Any
// thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace wall::client {

struct Parallel {
    std::string group;          ///< the same in all processes, unique on the wall
    std::uint32_t rank = 0;     ///< from 0
    std::uint32_t members = 1;  ///< processes in all
};

/// "GROUP:RANK:MEMBERS".
Result<Parallel> parse_parallel(std::string_view text);

/// What WALLGL_PARALLEL says of this process, read once; nothing without it, or if it is wrong (Hello::invalid says
/// so).
const std::optional<Parallel>& parallel();

}  // namespace wall::client
