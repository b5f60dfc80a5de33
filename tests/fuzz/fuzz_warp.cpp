// SPDX-License-Identifier: MIT
// Files of warps, which other programs write: one that can be drawn, or a sentence with the file's name.
#include "common/base/assert.h"
#include "common/config/read_warp.h"
#include "common/geom/tile_output.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto warp = wall::config::parse_warp({reinterpret_cast<const char*>(data), size}, "warp.toml");
    if (warp) WALL_ASSERT(wall::geom::wrong_with(*warp) == nullptr);
    else WALL_ASSERT(warp.error().message.starts_with("warp.toml"));
    return 0;
}
