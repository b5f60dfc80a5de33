// SPDX-License-Identifier: MIT
// What raw, lz4 and zstd share: a frame's bytes in a row, pressed by one function and restored by another. Every packet
// is a key frame:
//
//   packet := the pixels of all rows, top first, without padding, compressed
#pragma once

#include "common/codec/codec.h"

namespace wall::codec {

using Bytes = std::span<const std::byte>;

/// A general compressor of bytes. Both must be safe to call from any thread.
struct Compressor {
    std::function<std::size_t(std::size_t bytes)> bound;  ///< the most that `bytes` bytes can become
    /// Bytes written to `out` (bound() of them are there).
    std::function<Result<std::size_t>(Bytes from, std::span<std::byte> out)> compress;
    /// Fills `out` entirely, or says what the packet is instead.
    std::function<Result<void>(Bytes packet, std::span<std::byte> out)> restore;
};

Result<std::unique_ptr<Encoder>> make_packed_encoder(const StreamFormat& format, const Compressor& compressor);
Result<std::unique_ptr<Decoder>> make_packed_decoder(const StreamFormat& format, const Compressor& compressor);

/// The codec that one compressor makes; it must outlive that.
inline Codec packed_codec(std::string_view name, std::string_view summary, const Compressor& compressor) {
    return {name, summary,
            [&](const StreamFormat& format, ParallelFor) { return make_packed_encoder(format, compressor); },
            [&](const StreamFormat& format, Bytes, ParallelFor) { return make_packed_decoder(format, compressor); },
            &compressor};
}

}  // namespace wall::codec
