// SPDX-License-Identifier: MIT
// Who goes with whom, where not everybody goes with everybody. Pure; any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace wall::tileserver {

/// For each of `candidates` one of the numbers below `count` that are listed there, no number twice; what is listed
/// first is taken where that is possible. None: there is no such choice. (Augmenting paths: H. W. Kuhn, The Hungarian
/// method, 1955.)
std::optional<std::vector<std::size_t>> pair_up(std::span<const std::vector<std::size_t>> candidates,
                                                std::size_t count);

}  // namespace wall::tileserver
