// SPDX-License-Identifier: MIT
// Codec `huffyuv`: bit-compatible with HuffYUV 2.x as AVI files hold it (FourCC HFYU), and with the built-in tables
// of 1.x. RGB streams take and give bgra or rgba frames, YUY2 streams yuy2 ones. Every packet is a key frame. What a
// stream's header holds: huffyuv_format.h; the packets: docs/codecs.md.
#pragma once

#include <optional>

#include "common/codec/codec.h"
#include "common/codec/huffyuv_format.h"

namespace wall::codec::huffyuv {

struct EncoderOptions {
    std::optional<Predictor> predictor;  ///< none: the better one for the first frame
    bool decorrelate = true;             ///< RGB only
    bool classic = false;                ///< HuffYUV 1.x's tables, not those that suit the first frame
};

/// An encoder that tells also what an AVI file must say (huffyuv_format.h).
class StreamEncoder : public Encoder {
public:
    /// The stream that the packets belong to; known after the first encode().
    virtual const Stream& stream() const = 0;
};

/// Fails for what the format has not: see check() of huffyuv_format.h. `parallel` codes rows of RGB frames.
Result<std::unique_ptr<StreamEncoder>> make_stream_encoder(const StreamFormat& format, const EncoderOptions& options,
                                                           ParallelFor parallel = {});

/// For a stream as read_stream() gives it. `format.layout` must be yuy2 exactly for YUY2 streams.
Result<std::unique_ptr<Decoder>> make_stream_decoder(const StreamFormat& format, const Stream& stream);

}  // namespace wall::codec::huffyuv
