// SPDX-License-Identifier: MIT
// The frames of a data stream, in portions that the input itself chooses, and the parcels that come in them.
#include <algorithm>
#include <cstring>

#include "common/base/assert.h"
#include "common/wire/frame_reader.h"
#include "common/wire/parcel.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::uint32_t kLimit = 1 << 20;
    if (size < 1) return 0;
    const std::size_t portion = data[0] + std::size_t{1};
    wall::wire::FrameReader reader(kLimit);
    wall::wire::ParcelReader parcels;
    for (std::size_t at = 1; at < size;) {
        const auto room = reader.prepare();
        const std::size_t bytes = std::min({portion, size - at, room.size()});
        WALL_ASSERT(bytes > 0);
        std::memcpy(room.data(), data + at, bytes);
        reader.commit(bytes);
        at += bytes;
        for (;;) {
            auto frame = reader.next();
            if (!frame) return 0;
            if (!*frame) break;
            auto& payload = (*frame)->payload;
            WALL_ASSERT(payload.size() <= kLimit);
            if ((*frame)->kind != wall::wire::FrameKind::parcel) continue;
            const auto piece = wall::wire::read_parcel_piece(payload);
            if (!piece) return 0;
            WALL_ASSERT(piece->lead.position < piece->lead.route.size());
            const auto whole = parcels.take(*piece);
            if (!whole) return 0;
            const auto& lead = piece->lead;
            WALL_ASSERT(!*whole || (*whole)->size() == (lead.plain_bytes == 0 ? lead.bytes : lead.plain_bytes));
            wall::wire::hand_on_piece(payload);
        }
    }
    return 0;
}
