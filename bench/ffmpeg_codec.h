// SPDX-License-Identifier: MIT
// FFmpeg's lossless codecs, to compare ours with: frames in, packets out, and back. One thread drives it.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "common/codec/frame.h"

namespace wall::bench {

class FfmpegCodec {
public:
    /// `frames` (bgra) are brought into the codec's own pixel format here, not while it is timed. Throws when FFmpeg
    /// refuses.
    FfmpegCodec(const std::string& name, AVPixelFormat pixels, int threads,
                const std::vector<codec::FrameView>& frames);

    void encode();                  ///< all frames; with several threads some packets come with the next call
    void decode();                  ///< all packets of the first encode()
    double bits_per_pixel() const;  ///< of the packets that are decoded

private:
    struct Release {
        void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
        void operator()(AVFrame* frame) const { av_frame_free(&frame); }
        void operator()(AVPacket* packet) const { av_packet_free(&packet); }
    };
    using Context = std::unique_ptr<AVCodecContext, Release>;
    using Frame = std::unique_ptr<AVFrame, Release>;
    using Packet = std::unique_ptr<AVPacket, Release>;

    Context encoder_, decoder_;
    std::vector<Frame> frames_;
    std::vector<Packet> packets_;
    Frame decoded_;
};

}  // namespace wall::bench
