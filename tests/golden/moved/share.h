// SPDX-License-Identifier: MIT
// An image that all processes of a moved reference put together, each its own tile's pixels. They make the same calls
// in the same order, so the n-th exchange of one is the n-th of all.
#pragma once

#include <cstddef>
#include <span>

namespace golden::moved {

/// Rows of pixels in memory, the bottom one first.
struct Rows {
    std::byte* first = nullptr;  ///< pixel (0, 0) of the image
    std::size_t stride = 0, pixel_bytes = 0;
};

struct Box;

/// `image` covers `area` of the window and holds this process's part of it. Afterwards it holds those of all tiles;
/// what no tile covers is left alone. Blocks until all processes are there.
void exchange(const Rows& image, const Box& area);

}  // namespace golden::moved
