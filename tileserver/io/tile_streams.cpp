// SPDX-License-Identifier: MIT
#include "tileserver/io/tile_streams.h"

#include <sys/resource.h>

#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

#include "common/codec/codec.h"

namespace wall::tileserver {
namespace {

constexpr int kNice = 10;  // programs come first

std::uint64_t now_us() {
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch()).count());
}

void give_way() {
    thread_local const int once = ::setpriority(PRIO_PROCESS, 0, kNice);
    static_cast<void>(once);
}

std::string text_of(std::span<const std::byte> bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

}  // namespace

struct TileStreams::Stream {
    std::string codec;
    bool key = true;  // wanted next
    std::unique_ptr<codec::Encoder> encoder;
    codec::StreamFormat format;

    Result<void> encode(const Picture& picture, bool want_key, proto::StreamFrame& out) {
        const codec::StreamFormat now{picture.width, picture.height, codec::PixelLayout::rgba, false};
        const bool first = !encoder || !(now == format);
        if (first) {
            auto made = codec::make_encoder(codec, now);
            if (!made) return tl::unexpected(made.error());
            encoder = std::move(*made);
            format = now;
        }
        const codec::FrameView view{picture.rgba.data(), picture.width, picture.height, std::ptrdiff_t{4} * picture.width, codec::PixelLayout::rgba};
        std::vector<std::byte> packet;
        const auto kind = encoder->encode(view, want_key || first ? codec::PacketKind::key : codec::PacketKind::delta, packet);
        if (!kind) return tl::unexpected(kind.error());
        out.set_key(*kind == codec::PacketKind::key);
        if (first) out.set_header(text_of(encoder->stream_header()));
        out.set_packet(text_of(packet));
        return {};
    }
};

void TileStreams::start(RenderThread& render, const proto::StreamStart& message) {
    if (const auto known = codec::find_codec(message.codec()); !known) return fail(message.stream(), known.error().message);
    auto stream = std::make_shared<Stream>();
    stream->codec = message.codec();
    streams_[message.stream()] = std::move(stream);
    render.watch({message.stream(), true, message.slot(), SessionId(message.session()), message.width(), message.height()},
                 std::chrono::microseconds(message.interval_us()));
}

void TileStreams::stop(RenderThread& render, std::uint32_t stream) {
    render.unwatch(stream);
    streams_.erase(stream);
}

void TileStreams::stop_all(RenderThread& render) {
    for (const auto& [id, stream] : streams_) render.unwatch(id);
    streams_.clear();
}

void TileStreams::ready(RenderThread& render, const proto::StreamReady& message) {
    const auto at = streams_.find(message.stream());
    if (at == streams_.end()) return;
    at->second->key |= message.key();
    render.ready(message.stream(), message.key());
}

void TileStreams::picture(Picture picture) {
    const std::uint32_t id = picture.request.id;
    const auto at = streams_.find(id);
    if (at == streams_.end()) return;
    if (!picture.error.empty()) return fail(id, picture.error);
    asio::post(pool_, [this, id, stream = at->second, key = std::exchange(at->second->key, false), picture = std::move(picture)] {
        give_way();
        proto::Envelope envelope;
        auto& frame = *envelope.mutable_stream_frame();
        frame.set_stream(id);
        frame.set_time_us(now_us());
        frame.set_width(picture.width);
        frame.set_height(picture.height);
        if (const auto done = stream->encode(picture, key, frame); !done) frame.set_error(done.error().message);
        asio::post(executor_, [this, id, stream, envelope = std::move(envelope)] {
            const auto still = streams_.find(id);
            if (still == streams_.end() || still->second != stream) return;
            if (!envelope.stream_frame().error().empty()) streams_.erase(still);
            send_(envelope);
        });
    });
}

void TileStreams::fail(std::uint32_t stream, const std::string& why) {
    streams_.erase(stream);
    proto::Envelope envelope;
    envelope.mutable_stream_frame()->set_stream(stream);
    envelope.mutable_stream_frame()->set_error(why);
    send_(envelope);
}

}  // namespace wall::tileserver
