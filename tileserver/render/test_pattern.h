// SPDX-License-Identifier: MIT
// Pictures with which people set up a wall, instead of what programs draw (`wallctl pattern`). Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/geom/rect.h"

namespace wall::tileserver {

struct TestPattern {
    enum class Kind : std::uint8_t {
        grid,   ///< lines every 100 pixels of the canvas, thick ones every 500, the tile's edges and a circle
        ramps,  ///< grey, red, green and blue from dark to bright, and steps of each
        names,  ///< the label
        white,
        black,
        code,  ///< a bit of the Gray code of each pixel's column or row, for cameras (structured light)
    };
    /// Brightness of pixels, row by row, from the top left.
    struct Label {
        std::int32_t width = 0, height = 0;
        std::string bytes;
    };
    Kind kind = Kind::grid;
    bool on_output = false;  ///< in the pixels of the output, which does nothing to them
    std::uint32_t bit = 0;   ///< of `code`; 0: the one that changes most often
    bool rows = false;       ///< `code` tells rows, not columns
    bool inverted = false;   ///< `code` is dark where it would be bright
    Label label;
};

/// RGBA, top row first. `area`: of the canvas, so that patterns go on from tile to tile; of an output from (0, 0) on.
std::vector<std::byte> pattern_pixels(const TestPattern& pattern, const geom::Rect& area);

}  // namespace wall::tileserver
