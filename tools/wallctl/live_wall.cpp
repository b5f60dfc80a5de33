// SPDX-License-Identifier: MIT
#include "tools/wallctl/live_wall.h"

#include <algorithm>
#include <cstring>

#include "common/net/base64.h"

namespace wall::wallctl {
namespace {

using nlohmann::json;

constexpr std::chrono::seconds kAnswerLimit{10};
constexpr std::chrono::milliseconds kLook{100};  // how soon the thread sees that it shall stop
constexpr std::size_t kFrameHead = 20;           // bytes before the packet
constexpr const char* kCodec = "huffyuv-tiles";
constexpr codec::PixelLayout kLayout = codec::PixelLayout::rgba;

tl::unexpected<Failure> no(const char* code, std::string message) { return tl::unexpected<Failure>({code, std::move(message)}); }

/// "#RRGGBB"
std::uint32_t color_of(const std::string& text) { return static_cast<std::uint32_t>(std::stoul(text.substr(1), nullptr, 16)); }

geom::Rect rect_of(const json& rect) { return {rect.at(0), rect.at(1), rect.at(2), rect.at(3)}; }

}  // namespace

Outcome<std::unique_ptr<LiveWall>> LiveWall::open(const Walld& walld, const std::string& tile, unsigned fps) {
    const auto status = ask(walld, "status", json::object(), kAnswerLimit);
    if (!status) return tl::unexpected(status.error());
    std::vector<Tile> tiles;
    json watches = json::array();
    geom::Rect view{0, 0, status->json.at("wall").at("width"), status->json.at("wall").at("height")};
    for (const auto& row : status->json.at("tiles")) {
        if (!tile.empty() && row.at("name") != tile) continue;
        Tile one;
        one.name = row.at("name");
        one.rect = rect_of(row.at("rect"));
        one.expected = row.at("up");
        if (!tile.empty()) view = one.rect;
        watches.push_back({{"tile", one.name}, {"codec", kCodec}, {"fps", fps}});
        tiles.push_back(std::move(one));
    }
    if (tiles.empty()) return no("not_found", "there is no tile '" + tile + "'");
    for (auto& one : tiles) one.rect = {one.rect.x - view.x, one.rect.y - view.y, one.rect.width, one.rect.height};
    const codec::StreamFormat format{static_cast<std::uint32_t>(view.width), static_cast<std::uint32_t>(view.height), kLayout, false};
    if (const auto fits = codec::check(format); !fits) return no("failed", fits.error().message);
    auto client = subscribe(walld, "watch", {{"watch", watches}});
    if (!client) return tl::unexpected(client.error());
    return std::unique_ptr<LiveWall>(new LiveWall(std::move(*client), std::move(tiles), format, color_of(status->json.at("wall").at("background"))));
}

LiveWall::LiveWall(net::ControlClient client, std::vector<Tile> tiles, codec::StreamFormat format, std::uint32_t background)
    : client_(std::move(client)), tiles_(std::move(tiles)), format_(format), background_(background), picture_(format) {
    paint({0, 0, static_cast<std::int32_t>(format.width), static_cast<std::int32_t>(format.height)}, nullptr);
    thread_ = std::thread([this] { receive(); });
}

LiveWall::~LiveWall() {
    stop_ = true;
    thread_.join();
}

bool LiveWall::wait_complete(std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, limit, [this] { return !failure_.empty() || std::ranges::all_of(tiles_, [](const Tile& t) { return t.shown || !t.expected; }); });
}

Outcome<codec::Picture> LiveWall::picture() {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) return no("unavailable", failure_);
    return picture_;
}

void LiveWall::receive() {
    Result<void> good;
    while (!stop_ && good) {
        const auto message = client_.poll(kLook);
        if (!message) good = tl::unexpected(message.error());
        else if (!*message) continue;
        else if ((*message)->has_refused()) good = fail("walld refused: " + (*message)->refused().reason());
        else if ((*message)->has_operator_reply()) good = take((*message)->operator_reply());
    }
    if (stop_) return;
    const std::lock_guard lock(mutex_);
    failure_ = good.error().message;
    changed_.notify_all();
}

Result<void> LiveWall::take(const proto::OperatorReply& reply) {
    if (!reply.ok()) return fail(reply.error());
    if (!reply.blob().empty()) return take_frame(reply.blob());
    return take_text(json::parse(reply.json(), nullptr, false));
}

Result<void> LiveWall::take_text(const json& text) {
    if (text.contains("error")) return fail(text["error"].get<std::string>());
    const auto number = text.value("stream", tiles_.size());
    if (number >= tiles_.size()) return {};
    Tile& tile = tiles_[number];
    if (text.contains("ended")) {
        paint(tile.rect, nullptr);
        return {};
    }
    tile.format = {text.at("width"), text.at("height"), kLayout, false};
    const auto header = net::from_base64(text.at("header").get<std::string>());
    auto decoder = codec::make_decoder(text.at("codec").get<std::string>(), tile.format, header);
    if (!decoder) return tl::unexpected(decoder.error());
    tile.decoder = std::move(*decoder);
    return {};
}

Result<void> LiveWall::take_frame(std::string_view frame) {
    std::uint32_t number = 0;
    if (frame.size() < kFrameHead) return fail("a frame of " + std::to_string(frame.size()) + " bytes: expected at least " + std::to_string(kFrameHead));
    std::memcpy(&number, frame.data(), sizeof number);
    if (number >= tiles_.size() || !tiles_[number].decoder) return fail("a frame of a stream that was not announced");
    Tile& tile = tiles_[number];
    const auto decoded = tile.decoder->decode(std::as_bytes(std::span(frame.substr(kFrameHead))));
    if (!decoded) return fail("tile " + tile.name + ": " + decoded.error().message);
    paint(tile.rect, &*decoded);
    const std::lock_guard lock(mutex_);
    tile.shown = true;
    changed_.notify_all();
    return {};
}

/// The frame, or background, on a part of the picture.
void LiveWall::paint(const geom::Rect& rect, const codec::FrameView* frame) {
    const std::lock_guard lock(mutex_);
    const auto part = geom::intersect(rect, {0, 0, static_cast<std::int32_t>(format_.width), static_cast<std::int32_t>(format_.height)});
    const std::array<std::uint8_t, 4> color{static_cast<std::uint8_t>(background_ >> 16), static_cast<std::uint8_t>(background_ >> 8), static_cast<std::uint8_t>(background_), 255};
    for (std::int32_t y = 0; y < part.height; ++y) {
        std::byte* to = picture_.row(static_cast<std::uint32_t>(part.y + y)) + std::ptrdiff_t{4} * part.x;
        if (frame) {
            std::memcpy(to, frame->row(static_cast<std::uint32_t>(part.y - rect.y + y)) + std::ptrdiff_t{4} * (part.x - rect.x), std::size_t{4} * static_cast<std::size_t>(part.width));
        } else {
            for (std::int32_t x = 0; x < part.width; ++x) std::memcpy(to + std::ptrdiff_t{4} * x, color.data(), 4);
        }
    }
}

}  // namespace wall::wallctl
