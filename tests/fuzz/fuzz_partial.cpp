// SPDX-License-Identifier: MIT
// Partial pictures, as another node may have sent them: what is read is what would be written, and is merged.
#include "common/base/assert.h"
#include "tileserver/partials/partial_format.h"

using namespace wall::tileserver;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto partial = decode_partial(std::as_bytes(std::span(data, size)));
    if (!partial || std::int64_t{partial->area.width} * partial->area.height > 1 << 16) return 0;
    PixelBlock into{partial->area, false, {}, {}};
    into.colors.resize(into.pixels());
    into.depths.resize(into.pixels(), 0xffffff00);
    const bool depths = partial->depths.size() == partial->colors.size();
    WALL_ASSERT(merge(*partial, GL_LEQUAL, into) == depths);
    into.top_row_first = true;
    WALL_ASSERT(merge(*partial, GL_GEQUAL, into) == depths);
    WALL_ASSERT(merge(*partial, GL_BLEND, into));
    for (auto& depth : into.depths) depth |= 1;
    const auto again = decode_partial(encode_partial(partial->key, into, "lz4"));
    WALL_ASSERT(again && again->colors == into.colors && again->key == partial->key);
    return 0;
}
