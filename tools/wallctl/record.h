// SPDX-License-Identifier: MIT
// wallctl record: what the wall shows, as an AVI file with lossless HuffYUV that every player knows (docs/codecs.md).
#pragma once

#include "tools/request/request.h"

namespace wall::wallctl {

using request::Answer;
using request::Failure;
using request::Outcome;
using request::Walld;

struct Recording {
    std::string file, tile;  ///< tile empty: the whole wall
    double seconds = 10;
    unsigned fps = 10;
    bool output = false;   ///< of a tile: what its output shows
    bool progress = true;  ///< on standard error, once a second
};

/// {"file", "frames", "bytes", "width", "height", "fps"}. Ctrl-C ends it early and leaves a whole file.
Outcome<Answer> record(const Walld& walld, const Recording& recording);

}  // namespace wall::wallctl
