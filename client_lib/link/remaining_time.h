// SPDX-License-Identifier: MIT
// What poll() is told of a deadline. Any thread.
#pragma once

#include <chrono>

namespace wall::client {

/// Milliseconds, rounded up, so that it is over when poll() has waited for so long; 0 if it is over.
inline int remaining_ms(std::chrono::steady_clock::time_point deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    return left > 0 ? static_cast<int>(left) : 0;
}

}  // namespace wall::client
