// SPDX-License-Identifier: MIT
// Codec `huffyuv-tiles`: HuffYUV's idea (predict, decorrelate, prefix codes) over blocks and independent slices, for
// many threads, flat areas and small changes. It has no stream header. docs/codecs.md has the format.
#pragma once

#include "common/codec/codec.h"

namespace wall::codec::tiles {

Result<std::unique_ptr<Encoder>> make_encoder(const StreamFormat& format, ParallelFor parallel);
Result<std::unique_ptr<Decoder>> make_decoder(const StreamFormat& format, std::span<const std::byte> header,
                                              ParallelFor parallel);

}  // namespace wall::codec::tiles
