// SPDX-License-Identifier: MIT
// Codec `raw`: the pixels as they are.
#include <algorithm>

#include "common/codec/packed_codec.h"

namespace wall::codec {
namespace {

const Compressor kRaw{
    .bound = [](std::size_t bytes) { return bytes; },
    .compress = [](Bytes from, std::span<std::byte> out) -> Result<std::size_t> {
        std::ranges::copy(from, out.begin());
        return from.size();
    },
    .restore = [](Bytes packet, std::span<std::byte> out) -> Result<void> {
        if (packet.size() != out.size())
            return fail("raw: packet of " + std::to_string(packet.size()) + " bytes; expected " +
                        std::to_string(out.size()));
        std::ranges::copy(packet, out.begin());
        return {};
    },
};

}  // namespace

extern const Codec codec_raw;
const Codec codec_raw = packed_codec("raw", "pixels as they are", kRaw);

}  // namespace wall::codec
