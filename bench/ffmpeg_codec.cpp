// SPDX-License-Identifier: MIT
#include "bench/ffmpeg_codec.h"

#include <algorithm>
#include <stdexcept>

namespace wall::bench {
namespace {

void need(bool good, const std::string& what) {
    if (!good) throw std::runtime_error("FFmpeg: " + what);
}

/// BGRA into RGB24, or into the planes green, blue, red.
void fill(AVFrame& to, const codec::FrameView& from) {
    const bool packed = to.format == AV_PIX_FMT_RGB24;
    for (std::uint32_t y = 0; y < from.height; ++y) {
        const auto line = [&](int plane) {
            return to.data[plane] + static_cast<std::ptrdiff_t>(y) * to.linesize[plane];
        };
        std::uint8_t* const red = packed ? line(0) : line(2);
        std::uint8_t* const green = packed ? line(0) + 1 : line(0);
        std::uint8_t* const blue = packed ? line(0) + 2 : line(1);
        const std::size_t step = packed ? 3 : 1;
        const auto* row = reinterpret_cast<const std::uint8_t*>(from.row(y));
        for (std::size_t x = 0; x < from.width; ++x)
            blue[step * x] = row[4 * x], green[step * x] = row[4 * x + 1], red[step * x] = row[4 * x + 2];
    }
}

}  // namespace

FfmpegCodec::FfmpegCodec(const std::string& name, AVPixelFormat pixels, int threads,
                         const std::vector<codec::FrameView>& frames)
    : decoded_(av_frame_alloc()) {
    av_log_set_level(AV_LOG_ERROR);
    const AVCodec* encoder = avcodec_find_encoder_by_name(name.c_str());
    const AVCodec* decoder = avcodec_find_decoder_by_name(name.c_str());
    need(encoder != nullptr && decoder != nullptr, "no codec " + name);
    encoder_.reset(avcodec_alloc_context3(encoder));
    encoder_->width = static_cast<int>(frames[0].width), encoder_->height = static_cast<int>(frames[0].height);
    encoder_->pix_fmt = pixels, encoder_->time_base = {1, 25}, encoder_->thread_count = threads;
    need(avcodec_open2(encoder_.get(), encoder, nullptr) >= 0, "cannot open the encoder of " + name);
    for (const auto& view : frames) {
        Frame frame(av_frame_alloc());
        frame->width = encoder_->width, frame->height = encoder_->height, frame->format = pixels;
        need(av_frame_get_buffer(frame.get(), 0) >= 0, "no memory");
        fill(*frame, view);
        frames_.push_back(std::move(frame));
    }
    decoder_.reset(avcodec_alloc_context3(decoder));
    decoder_->width = encoder_->width, decoder_->height = encoder_->height, decoder_->thread_count = threads;
    decoder_->codec_tag = encoder_->codec_tag, decoder_->bits_per_coded_sample = encoder_->bits_per_coded_sample;
    if (encoder_->extradata_size > 0) {
        decoder_->extradata = static_cast<std::uint8_t*>(
            av_mallocz(static_cast<std::size_t>(encoder_->extradata_size) + AV_INPUT_BUFFER_PADDING_SIZE));
        std::copy_n(encoder_->extradata, encoder_->extradata_size, decoder_->extradata);
        decoder_->extradata_size = encoder_->extradata_size;
    }
    need(avcodec_open2(decoder_.get(), decoder, nullptr) >= 0, "cannot open the decoder of " + name);
    while (packets_.size() < frames_.size()) encode();
}

void FfmpegCodec::encode() {
    const bool keep = packets_.size() < frames_.size();
    Packet packet(av_packet_alloc());
    for (const auto& frame : frames_) {
        frame->pts = AV_NOPTS_VALUE;
        need(avcodec_send_frame(encoder_.get(), frame.get()) >= 0, "a frame is refused");
        while (avcodec_receive_packet(encoder_.get(), packet.get()) >= 0) {
            if (keep && packets_.size() < frames_.size()) packets_.emplace_back(av_packet_clone(packet.get()));
            av_packet_unref(packet.get());
        }
    }
}

void FfmpegCodec::decode() {
    for (const auto& packet : packets_) {
        need(avcodec_send_packet(decoder_.get(), packet.get()) >= 0, "a packet is refused");
        while (avcodec_receive_frame(decoder_.get(), decoded_.get()) >= 0) av_frame_unref(decoded_.get());
    }
}

double FfmpegCodec::bits_per_pixel() const {
    double bytes = 0;
    for (const auto& packet : packets_) bytes += packet->size;
    return 8 * bytes / (static_cast<double>(packets_.size()) * encoder_->width * encoder_->height);
}

}  // namespace wall::bench
