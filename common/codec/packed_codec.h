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
    std::size_t (*bound)(std::size_t bytes);  ///< the most that `bytes` bytes can become
    /// Bytes written to `out` (bound() of them are there).
    Result<std::size_t> (*compress)(Bytes from, std::span<std::byte> out);
    /// Fills `out` entirely, or says what the packet is instead.
    Result<void> (*restore)(Bytes packet, std::span<std::byte> out);
};

Result<std::unique_ptr<Encoder>> make_packed_encoder(const StreamFormat& format, const Compressor& compressor);
Result<std::unique_ptr<Decoder>> make_packed_decoder(const StreamFormat& format, const Compressor& compressor);

/// The functions a `Codec` wants, for one compressor.
template <const Compressor& compressor>
struct PackedCodec {
    static Result<std::unique_ptr<Encoder>> encoder(const StreamFormat& format, ParallelFor) {
        return make_packed_encoder(format, compressor);
    }
    static Result<std::unique_ptr<Decoder>> decoder(const StreamFormat& format, Bytes, ParallelFor) {
        return make_packed_decoder(format, compressor);
    }
};

}  // namespace wall::codec
