// SPDX-License-Identifier: MIT
// Which part of a program's window this process draws. A moved reference is one process per tile, each of which runs
// the same program on plain Mesa with everything moved so that its tile's left top pixel is that of the window.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace golden::moved {

/// Pixels of the program's window, origin bottom left.
struct Box {
    int x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width <= 0 || height <= 0; }
};
Box intersect(const Box& a, const Box& b);

struct Place {
    Box window;
    std::vector<Box> tiles;
    std::size_t own = 0;
    std::string share;  ///< file through which the processes show each other what they have drawn

    const Box& part() const { return tiles[own]; }
    /// What is added to a window position.
    int dx() const { return -part().x; }
    int dy() const { return window.height - part().y - part().height; }
};

/// As the environment says: GOLDEN_TILES="WIDTH,HEIGHT;X,Y,W,H;..." (the window, then its tiles from the top left, y
/// down), GOLDEN_TILE=INDEX, GOLDEN_SHARE=FILE. Ends the process where it says nothing sensible.
const Place& place();

/// Ends the process: a picture that is not sure to be right is worse than none.
[[noreturn]] void stop(const char* what);

}  // namespace golden::moved
