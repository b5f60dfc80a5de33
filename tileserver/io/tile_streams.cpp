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
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
            .count());
}

void give_way() {
    thread_local const int once = ::setpriority(PRIO_PROCESS, 0, kNice);
    static_cast<void>(once);
}

std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

struct TileStreams::Stream {
    /// Since the start; the I/O thread's.
    struct Cost {
        std::uint64_t frames = 0, raw_bytes = 0, packet_bytes = 0;
        std::chrono::steady_clock::duration time{};

        Cost& operator+=(const Cost& other) {
            frames += other.frames;
            raw_bytes += other.raw_bytes;
            packet_bytes += other.packet_bytes;
            time += other.time;
            return *this;
        }
    };

    std::string codec;
    bool key = true;  // wanted next
    Cost cost;
    std::unique_ptr<codec::Encoder> encoder;
    codec::StreamFormat format;

    Result<void> encode(const Picture& picture, bool want_key, proto::StreamFrame& out,
                        std::vector<std::byte>& packet) {
        const codec::StreamFormat now{picture.width, picture.height, codec::PixelLayout::rgba, false};
        const bool first = !encoder || !(now == format);
        if (first) {
            auto made = codec::make_encoder(codec, now);
            if (!made) return tl::unexpected(made.error());
            encoder = std::move(*made);
            format = now;
        }
        const codec::FrameView view{picture.rgba.data(), picture.width, picture.height,
                                    std::ptrdiff_t{4} * picture.width, codec::PixelLayout::rgba};
        const auto kind =
            encoder->encode(view, want_key || first ? codec::PacketKind::key : codec::PacketKind::delta, packet);
        if (!kind) return tl::unexpected(kind.error());
        out.set_key(*kind == codec::PacketKind::key);
        if (first) out.set_header(text_of(encoder->stream_header()));
        return {};
    }
};

/// A frame that the pool has encoded.
struct TileStreams::Made {
    proto::StreamFrame head;
    std::vector<std::byte> packet;
    Stream::Cost cost;                 ///< of this one
    std::shared_ptr<const void> hold;  ///< the picture's share of what may be on its way
};

void TileStreams::start(RenderThread& render, const proto::StreamStart& message) {
    const PictureId id(message.stream());
    if (const auto known = codec::find_codec(message.codec()); !known) return fail(id, known.error().message);
    auto stream = std::make_shared<Stream>();
    stream->codec = message.codec();
    streams_[id] = std::move(stream);
    const auto& crop = message.crop();
    const geom::Rect part{crop.x(), crop.y(), static_cast<std::int32_t>(crop.width()),
                          static_cast<std::int32_t>(crop.height())};
    render.watch({id, true, message.slot(), SessionId(message.session()), SurfaceId(message.surface()), part,
                  message.width(), message.height(), message.output()},
                 std::chrono::microseconds(message.interval_us()));
}

void TileStreams::stop(RenderThread& render, PictureId stream) {
    render.unwatch(stream);
    streams_.erase(stream);
}

void TileStreams::stop_all(RenderThread& render) {
    for (const auto& [id, stream] : streams_) render.unwatch(id);
    streams_.clear();
}

void TileStreams::ready(RenderThread& render, const proto::StreamReady& message) {
    const PictureId id(message.stream());
    const auto at = streams_.find(id);
    if (at == streams_.end()) return;
    at->second->key |= message.key();
    render.ready(id, message.key());
}

void TileStreams::picture(Picture picture) {
    const PictureId id = picture.request.id;
    const auto at = streams_.find(id);
    if (at == streams_.end()) return;
    if (!picture.error.empty()) return fail(id, picture.error);
    asio::post(pool_, [this, id, stream = at->second, key = std::exchange(at->second->key, false),
                       picture = std::move(picture)] {
        give_way();
        auto made = std::make_shared<Made>(make(*stream, id, key, picture));
        asio::post(executor_, [this, stream, made] { deliver(stream, std::move(*made)); });
    });
}

/// On the pool's thread.
TileStreams::Made TileStreams::make(Stream& stream, PictureId id, bool key, const Picture& picture) {
    Made made;
    made.head.set_stream(id.value);
    made.head.set_time_us(now_us());
    made.head.set_width(picture.width);
    made.head.set_height(picture.height);
    const auto start = std::chrono::steady_clock::now();
    const auto done = stream.encode(picture, key, made.head, made.packet);
    if (!done) made.head.set_error(done.error().message);
    made.cost = {1, picture.rgba.size(), made.packet.size(), std::chrono::steady_clock::now() - start};
    made.hold = picture.hold;
    return made;
}

void TileStreams::deliver(const std::shared_ptr<Stream>& stream, Made made) {
    const PictureId id(made.head.stream());
    const auto still = streams_.find(id);
    if (still == streams_.end() || still->second != stream) return;
    if (!made.head.error().empty()) return fail(id, made.head.error());
    stream->cost += made.cost;
    send_(id, frame_parts(std::move(made.head), std::move(made.packet), std::move(made.hold)));
}

void TileStreams::fill_stats(proto::NodeStats& out) const {
    for (const auto& [id, stream] : streams_) {
        auto& row = *out.add_streams();
        row.set_stream(id.value);
        row.set_frames(stream->cost.frames);
        row.set_raw_bytes(stream->cost.raw_bytes);
        row.set_packet_bytes(stream->cost.packet_bytes);
        row.set_encode_ns(static_cast<std::uint64_t>(std::chrono::nanoseconds(stream->cost.time).count()));
    }
}

void TileStreams::fail(PictureId stream, const std::string& why) {
    streams_.erase(stream);
    proto::StreamFrame end;
    end.set_stream(stream.value);
    end.set_error(why);
    send_(stream, frame_parts(std::move(end), {}, nullptr));
}

}  // namespace wall::tileserver
