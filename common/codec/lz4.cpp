// SPDX-License-Identifier: MIT
// Codec `lz4`: one LZ4 block a frame (liblz4).
#include <lz4.h>

#include "common/codec/packed_codec.h"

namespace wall::codec {
namespace {

static_assert(kMaxPixels * 4 <= LZ4_MAX_INPUT_SIZE);

const Compressor kLz4{
    .bound = [](std::size_t bytes) { return static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes))); },
    .compress = [](Bytes from, std::span<std::byte> out) -> Result<std::size_t> {
        const int written =
            LZ4_compress_default(reinterpret_cast<const char*>(from.data()), reinterpret_cast<char*>(out.data()),
                                 static_cast<int>(from.size()), static_cast<int>(out.size()));
        if (written <= 0) return fail("lz4: compression failed");
        return static_cast<std::size_t>(written);
    },
    .restore = [](Bytes packet, std::span<std::byte> out) -> Result<void> {
        if (packet.size() > LZ4_MAX_INPUT_SIZE)
            return fail("lz4: packet of " + std::to_string(packet.size()) + " bytes; the limit is 2113929216");
        const int written =
            LZ4_decompress_safe(reinterpret_cast<const char*>(packet.data()), reinterpret_cast<char*>(out.data()),
                                static_cast<int>(packet.size()), static_cast<int>(out.size()));
        if (written < 0) return fail("lz4: packet is not a block of " + std::to_string(out.size()) + " bytes");
        if (static_cast<std::size_t>(written) != out.size())
            return fail("lz4: packet holds " + std::to_string(written) + " bytes; expected " +
                        std::to_string(out.size()));
        return {};
    },
};

}  // namespace

extern const Codec codec_lz4;
const Codec codec_lz4 = packed_codec("lz4", "LZ4 over the pixels", kLz4);

}  // namespace wall::codec
