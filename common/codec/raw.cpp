// SPDX-License-Identifier: MIT
// Codec `raw`: the pixels as they are.
#include <cstring>

#include "common/codec/packed_codec.h"

namespace wall::codec {
namespace {

const Compressor kRaw{
    .bound = [](std::size_t bytes) { return bytes; },
    .compress = [](Bytes from, std::span<std::byte> out) -> Result<std::size_t> {
        std::memcpy(out.data(), from.data(), from.size());
        return from.size();
    },
    .restore = [](Bytes packet, std::span<std::byte> out) -> Result<void> {
        if (packet.size() != out.size())
            return fail("raw: packet of " + std::to_string(packet.size()) + " bytes; expected " +
                        std::to_string(out.size()));
        std::memcpy(out.data(), packet.data(), out.size());
        return {};
    },
};

}  // namespace

extern const Codec codec_raw;
const Codec codec_raw = packed_codec("raw", "pixels as they are", kRaw);

}  // namespace wall::codec
