// SPDX-License-Identifier: MIT
// Everything in a batch and in a recorded list begins at a multiple of 4 bytes. Pure.
#pragma once

#include <cstddef>

namespace wall::wire {

/// The next multiple of 4.
constexpr std::size_t padded4(std::size_t bytes) { return (bytes + 3) & ~std::size_t{3}; }

}  // namespace wall::wire
