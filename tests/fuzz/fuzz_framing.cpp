// SPDX-License-Identifier: MIT
// The frames of a data stream, in portions that the input itself chooses.
#include <algorithm>
#include <cstring>

#include "common/base/assert.h"
#include "common/wire/frame_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::uint32_t kLimit = 1 << 20;
    if (size < 1) return 0;
    const std::size_t portion = data[0] + std::size_t{1};
    wall::wire::FrameReader reader(kLimit);
    for (std::size_t at = 1; at < size;) {
        const auto room = reader.prepare();
        const std::size_t bytes = std::min({portion, size - at, room.size()});
        WALL_ASSERT(bytes > 0);
        std::memcpy(room.data(), data + at, bytes);
        reader.commit(bytes);
        at += bytes;
        for (;;) {
            const auto frame = reader.next();
            if (!frame) return 0;
            if (!*frame) break;
            WALL_ASSERT((*frame)->payload.size() <= kLimit);
        }
    }
    return 0;
}
