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
    std::string rgb;  ///< rect.width * rect.height * 3 bytes, top row first; empty: nothing came
};

struct PictureJob {
    geom::Rect view;               ///< part of the canvas that is wanted
    std::uint32_t background = 0;  ///< 0xRRGGBB where no tile is
    std::vector<TilePicture> tiles;
};

/// PNG, 8 bits RGB.
Result<std::string> compose_png(const PictureJob& job);

}  // namespace wall::walld
