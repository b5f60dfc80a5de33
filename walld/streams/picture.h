// SPDX-License-Identifier: MIT
// The wall's picture out of its tiles' pixels. Pure; run on the picture thread, it takes long on a large wall.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/geom/rect.h"

namespace wall::walld {

struct TilePicture {
    geom::Rect rect;  ///< on the canvas
    std::string rgb;  ///< what has come of its rect.width * rect.height * 3 bytes, top row first

    std::size_t bytes() const;
    bool complete() const { return rgb.size() == bytes(); }
    /// The next part of a picture of `width` x `height` pixels. False: it is of another size, out of order or too long.
    bool add(std::uint32_t width, std::uint32_t height, std::uint64_t offset, const std::string& part);
};

struct PictureJob {
    geom::Rect view;               ///< part of the canvas that is wanted
    std::uint32_t background = 0;  ///< 0xRRGGBB where no tile is
    std::vector<TilePicture> tiles;
};

/// PNG, 8 bits RGB. A tile that has not all come is left out. Takes the tiles, so that each is freed when it is drawn.
Result<std::string> compose_png(PictureJob job);

}  // namespace wall::walld
