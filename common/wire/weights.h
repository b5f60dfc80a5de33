// SPDX-License-Identifier: MIT
// A session's share of nodes' time, in proportion to those of the others that want some.
#pragma once

#include <cstdint>

namespace wall::wire {

inline constexpr std::uint32_t kUsualWeight = 10, kMostWeight = 100;  ///< the least is 1

}  // namespace wall::wire
