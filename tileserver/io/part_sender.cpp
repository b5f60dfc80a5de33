// SPDX-License-Identifier: MIT
#include "tileserver/io/part_sender.h"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <cstring>
#include <utility>

#include "common/wire/limits.h"

namespace wall::tileserver {
namespace {

constexpr std::size_t kRgba = 4, kRgb = 3;                      // bytes of a pixel
constexpr std::size_t kPartPixels = wire::kControlPart / kRgb;  // of a snapshot

std::string to_rgb(std::span<const std::byte> rgba) {
    std::string rgb(rgba.size() / kRgba * kRgb, '\0');
    char* to = rgb.data();
    for (const std::byte* from = rgba.data(); from != rgba.data() + rgba.size(); from += kRgba, to += kRgb)
        std::memcpy(to, from, kRgb);
    return rgb;
}

}  // namespace

Parts snapshot_parts(Picture picture) {
    return [picture = std::move(picture), done = std::size_t{0},
            over = false]() mutable -> std::optional<proto::Envelope> {
        const std::size_t pixels = picture.rgba.size() / kRgba;
        if (std::exchange(over, over || pixels - done <= kPartPixels)) return std::nullopt;
        const std::size_t count = std::min(kPartPixels, pixels - done);
        proto::Envelope envelope;
        auto& snapshot = *envelope.mutable_snapshot();
        snapshot.set_request(picture.request.id.value);
        snapshot.set_width(picture.width);
        snapshot.set_height(picture.height);
        snapshot.set_offset(done * kRgb);
        snapshot.set_rgb(to_rgb(std::span(picture.rgba).subspan(done * kRgba, count * kRgba)));
        snapshot.set_error(picture.error);
        done += count;
        return envelope;
    };
}

Parts frame_parts(proto::StreamFrame head, std::vector<std::byte> packet, std::shared_ptr<const void> keep) {
    return [head = std::move(head), packet = std::move(packet), keep = std::move(keep), done = std::size_t{0},
            over = false]() mutable -> std::optional<proto::Envelope> {
        if (std::exchange(over, over || packet.size() - done <= wire::kControlPart)) return std::nullopt;
        const std::size_t count = std::min<std::size_t>(wire::kControlPart, packet.size() - done);
        proto::Envelope envelope;
        auto& frame = *envelope.mutable_stream_frame();
        if (done == 0) frame = head;
        frame.set_stream(head.stream());
        frame.set_packet_bytes(packet.size());
        frame.set_offset(done);
        frame.set_packet(packet.data() + done, count);
        done += count;
        return envelope;
    };
}

void PartSender::use(std::shared_ptr<net::ControlConnection> link) {
    if (line_) {
        line_->waiting.clear();
        line_->link.reset();
    }
    line_ = link ? std::make_shared<Line>(Line{std::move(link), {}, false}) : nullptr;
}

void PartSender::send(const PartsOf& of, Parts parts) {
    if (!line_) return;
    auto at = std::ranges::find(line_->waiting, of, &Waiting::of);
    if (at == line_->waiting.end()) at = line_->waiting.insert(at, Waiting{of, {}});
    at->parts.push_back(std::move(parts));
    if (!std::exchange(line_->running, true)) asio::co_spawn(executor_, run(line_), asio::detached);
}

asio::awaitable<void> PartSender::run(std::shared_ptr<Line> line) {
    while (!line->waiting.empty()) {
        auto turn = std::move(line->waiting.front());
        line->waiting.pop_front();
        const auto part = turn.parts.front()();
        if (!part) turn.parts.pop_front();
        if (!turn.parts.empty()) line->waiting.push_back(std::move(turn));
        if (!part) continue;
        const auto link = line->link;
        link->send(*part);
        co_await link->drained();
        if (!link->is_open()) line->waiting.clear();
    }
    line->running = false;
}

}  // namespace wall::tileserver
