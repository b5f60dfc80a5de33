// SPDX-License-Identifier: MIT
// Codec `zstd`: one Zstandard frame a picture, level 1 (libzstd).
#include <zstd.h>

#include "common/codec/packed_codec.h"

namespace wall::codec {
namespace {

constexpr int kLevel = 1;  ///< monitor streams want speed

const Compressor kZstd{
    .bound = [](std::size_t bytes) { return ZSTD_compressBound(bytes); },
    .compress = [](Bytes from, std::span<std::byte> out) -> Result<std::size_t> {
        const std::size_t written = ZSTD_compress(out.data(), out.size(), from.data(), from.size(), kLevel);
        if (ZSTD_isError(written)) return fail(std::string("zstd: ") + ZSTD_getErrorName(written));
        return written;
    },
    .restore = [](Bytes packet, std::span<std::byte> out) -> Result<void> {
        const std::size_t written = ZSTD_decompress(out.data(), out.size(), packet.data(), packet.size());
        if (ZSTD_isError(written)) return fail(std::string("zstd: bad packet: ") + ZSTD_getErrorName(written));
        if (written != out.size())
            return fail("zstd: packet holds " + std::to_string(written) + " bytes; expected " +
                        std::to_string(out.size()));
        return {};
    },
};

}  // namespace

extern const Codec codec_zstd;
const Codec codec_zstd = packed_codec("zstd", "Zstandard level 1 over the pixels", kZstd);

}  // namespace wall::codec
