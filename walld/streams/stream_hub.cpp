// SPDX-License-Identifier: MIT
#include "walld/streams/stream_hub.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/codec/frame.h"
#include "common/net/base64.h"
#include "walld/wall/messages.h"

namespace wall::walld {
namespace {

using nlohmann::json;

template <class T>
void append(std::string& out, T value) {
    for (std::size_t i = 0; i < sizeof value; ++i) out += static_cast<char>(value >> 8 * i & 0xff);
}

constexpr const char* kNoRoom = "the wall's streams are all in use";
constexpr std::uint64_t kMaxPacket = std::uint64_t{8} * codec::kMaxPixels;  // bytes; twice what pixels have

json rect_json(const geom::Rect& rect) { return {rect.x, rect.y, rect.width, rect.height}; }

}  // namespace

// ---- viewers ----

void StreamHub::Viewer::tell_error(const std::string& what) {
    error_ = what;
    news_.notify();
}

Outcome<std::shared_ptr<StreamHub::Viewer>> StreamHub::add_viewer(const Person& who) {
    auto place = places_.take(who.text(), {wall_.config().quota.person_views, "person_views"});
    if (!place) return tl::unexpected(place.error());
    auto viewer = std::make_shared<Viewer>(executor_, who.text(), std::move(*place));
    viewers_[viewer.get()] = viewer;
    return viewer;
}

void StreamHub::remove_viewer(Viewer& viewer) {
    std::vector<Key> old;
    for (std::uint32_t i = 0; i < viewer.watches_.size(); ++i)
        std::ranges::move(leave(viewer, i), std::back_inserter(old));
    viewer.watches_.clear();
    drop_unwatched(old);
    viewers_.erase(&viewer);
}

StreamHub::Watch StreamHub::make_watch(const WatchRequest& request, const StreamScope& scope) const {
    Watch watch{.request = request, .scope = scope};
    for (const auto& [node, slot, crop, at] : parts_of(wall_, scope)) {
        const auto width = static_cast<std::uint32_t>(at.width), height = static_cast<std::uint32_t>(at.height);
        watch.parts.push_back({.key = {node, slot, scope.session, scope.surface, crop.x, crop.y, crop.width,
                                       crop.height, request.codec, width, height, request.fps, scope.output},
                               .at = at});
    }
    return watch;
}

/// The nodes' streams that a person watches without these.
std::set<StreamHub::Key> StreamHub::watched_by(const std::string& who, std::span<const Watch> but) const {
    std::set<Key> keys;
    for (const auto& [viewer, owner] : viewers_) {
        if (viewer->who_ != who) continue;
        for (const auto& watch : viewer->watches_) {
            if (std::ranges::any_of(but, [&](const Watch& other) { return &other == &watch; })) continue;
            for (const auto& part : watch.parts) keys.insert(part.key);
        }
    }
    return keys;
}

/// Whether the viewer may watch these in place of those, beside what is watched otherwise.
Result<void> StreamHub::check_room(const Viewer& viewer, std::span<const Watch> watches,
                                   std::span<const Watch> instead_of) const {
    const auto parts_of = [](std::span<const Watch> of) {
        std::size_t parts = 0;
        for (const auto& watch : of) parts += watch.parts.size();
        return parts;
    };
    const auto parts = parts_of(viewer.watches_) - parts_of(instead_of) + parts_of(watches);
    if (parts > kMaxPartsOfViewer)
        return fail(fmt::format("{} parts of tiles are more than the {} of a viewer", parts, kMaxPartsOfViewer));
    auto mine = watched_by(viewer.who_, instead_of);
    std::set<Key> fresh;
    for (const auto& watch : watches) {
        for (const auto& part : watch.parts) {
            mine.insert(part.key);
            if (!streams_.contains(part.key)) fresh.insert(part.key);
        }
    }
    if (mine.size() > kMaxStreamsOfOne)
        return fail(fmt::format("{} may watch {} different parts of tiles, and these would be {}", viewer.who_,
                                kMaxStreamsOfOne, mine.size()));
    std::uint64_t pixels = 0;
    for (const auto& [key, stream] : streams_) pixels += key.pixels();
    for (const auto& key : fresh) pixels += key.pixels();
    if (streams_.size() + fresh.size() > kMaxNodeStreams || pixels > kMaxPixels) return fail(kNoRoom);
    return {};
}

Result<void> StreamHub::watch(Viewer& viewer, const std::vector<WatchRequest>& requests) {
    std::vector<Watch> watches;
    for (const auto& request : requests) {
        const auto scope = scope_of(wall_, request);
        if (!scope) return fail(fmt::format("watch[{}]{}", watches.size(), scope.error().message));
        watches.push_back(make_watch(request, *scope));
    }
    if (auto room = check_room(viewer, watches, viewer.watches_); !room) return fail("watch: " + room.error().message);
    std::vector<Key> old;
    for (std::uint32_t i = 0; i < viewer.watches_.size(); ++i)
        std::ranges::move(leave(viewer, i), std::back_inserter(old));
    viewer.watches_ = std::move(watches);
    for (std::uint32_t i = 0; i < viewer.watches_.size(); ++i) join(viewer, i);
    drop_unwatched(old);
    viewer.news_.notify();
    return {};
}

/// Gives what may be watched by nobody now. What others join before drop_unwatched() does not end and begin anew.
std::vector<StreamHub::Key> StreamHub::leave(Viewer& viewer, std::uint32_t number) {
    std::vector<Key> left;
    const auto& parts = viewer.watches_[number].parts;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        streams_.at(parts[i].key).watchers.erase({&viewer, number, i});
        left.push_back(parts[i].key);
    }
    return left;
}

void StreamHub::join(Viewer& viewer, std::uint32_t number) {
    const auto& parts = viewer.watches_[number].parts;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        const Key& key = parts[i].key;
        const auto [at, fresh] = streams_.try_emplace(key);
        at->second.watchers.insert({&viewer, number, i});
        if (!fresh) {
            ask_for_more(*at);  // an unchanged picture would never come by itself
            continue;
        }
        at->second.id = last_id_ = PictureId(last_id_.value + 1);
        by_id_[at->second.id] = at;
        if (wall_.nodes()[key.node].up) start(key, at->second);
    }
}

void StreamHub::drop_unwatched(const std::vector<Key>& keys) {
    for (const auto& key : keys) {
        const auto at = streams_.find(key);
        if (at == streams_.end()) continue;
        if (!at->second.watchers.empty()) {
            ask_for_more(*at);  // who left may have been the one that was waited for
            continue;
        }
        proto::StreamStop stop;
        stop.set_stream(at->second.id.value);
        out_.to_node(key.node, make(&proto::Envelope::mutable_stream_stop, stop));
        by_id_.erase(at->second.id);
        streams_.erase(at);
    }
}

void StreamHub::tick(Clock::time_point now) {
    deadline_.reset();
    for (auto& [viewer, owner] : viewers_)
        for (std::uint32_t i = 0; i < viewer->watches_.size(); ++i)
            if (viewer->watches_[i].request.follows()) follow(*viewer, i, now);
}

/// Not more often than frames are wanted: each move of the window makes other streams of the nodes.
void StreamHub::follow(Viewer& viewer, std::uint32_t number, Clock::time_point now) {
    Watch& watch = viewer.watches_[number];
    const auto scope = scope_of(wall_, watch.request);
    if (scope ? watch.scope == *scope : !watch.scope) return;
    if (scope && now < watch.not_before) {
        deadline_ = std::min(deadline_.value_or(watch.not_before), watch.not_before);
        return;
    }
    if (find_anew(viewer, number, scope))
        watch.not_before = now + std::chrono::microseconds(1'000'000 / watch.request.fps);
}

/// False: there is still nothing to see, as was said.
bool StreamHub::find_anew(Viewer& viewer, std::uint32_t number, const Result<StreamScope>& scope) {
    Watch& watch = viewer.watches_[number];
    Watch next = scope ? make_watch(watch.request, *scope)
                       : Watch{.request = watch.request,
                               .ended = scope.error().message.substr(scope.error().message.find(": ") + 2)};
    if (const auto room = check_room(viewer, {&next, 1}, {&watch, 1}); !room) {
        if (!watch.scope) return false;
        next = Watch{.request = watch.request, .ended = room.error().message};
    }
    const auto old = leave(viewer, number);
    watch = std::move(next);
    join(viewer, number);
    drop_unwatched(old);
    viewer.news_.notify();
    return true;
}

void StreamHub::wall_changed(Clock::time_point now) {
    for (auto& [viewer, owner] : viewers_)
        for (std::uint32_t i = 0; i < viewer->watches_.size(); ++i)
            find_anew(*viewer, i, scope_of(wall_, viewer->watches_[i].request));
    tick(now);
}

std::string StreamHub::tile_name(const Key& key) const {
    const auto* tile = wall_.nodes()[key.node].config->tile(key.slot);
    return tile ? tile->name : std::string();
}

std::string StreamHub::parts_text(std::uint32_t number, const Watch& watch) const {
    auto parts = json::array();
    for (const auto& part : watch.parts)
        parts.push_back(
            {{"tile", tile_name(part.key)}, {"rect", rect_json(part.at)}, {"away", !wall_.nodes()[part.key.node].up}});
    return json{{"stream", number},
                {"codec", watch.request.codec},
                {"layout", "rgba"},
                {"width", watch.scope->width},
                {"height", watch.scope->height},
                {"shows", rect_json(watch.scope->rect)},
                {"background", fmt::format("#{:06x}", wall_.config().background)},
                {"parts", parts}}
        .dump();
}

std::optional<ViewerMessage> StreamHub::next(Viewer& viewer) {
    if (!viewer.error_.empty())
        return ViewerMessage{false, json{{"error", std::exchange(viewer.error_, {})}}.dump(), nullptr};
    const auto count = static_cast<std::uint32_t>(viewer.watches_.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t number = (viewer.turn_ + k) % count;
        auto message = next_of(viewer, number);
        if (!message) continue;
        if (message->binary) viewer.turn_ = number + 1;
        return message;
    }
    return std::nullopt;
}

std::optional<ViewerMessage> StreamHub::next_of(Viewer& viewer, std::uint32_t number) {
    Watch& watch = viewer.watches_[number];
    if (!watch.ended.empty())
        return ViewerMessage{false, json{{"stream", number}, {"ended", std::exchange(watch.ended, {})}}.dump(),
                             nullptr};
    if (watch.scope && !std::exchange(watch.told, true))
        return ViewerMessage{false, parts_text(number, watch), nullptr};
    const auto count = static_cast<std::uint32_t>(watch.parts.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t i = (watch.turn + k) % count;
        Part& part = watch.parts[i];
        if (!part.ended.empty())
            return ViewerMessage{
                false, json{{"stream", number}, {"part", i}, {"ended", std::exchange(part.ended, {})}}.dump(), nullptr};
        if (!part.frame) continue;
        auto& stream = *streams_.find(part.key);
        if (!std::exchange(part.announced, true))
            return ViewerMessage{false, json{{"stream", number}, {"part", i}, {"header", *stream.second.header}}.dump(),
                                 nullptr};
        watch.turn = i + 1;
        const Frame frame = *std::exchange(part.frame, std::nullopt);
        ViewerMessage out{true, {}, frame.packet};
        append(out.head, number);
        append(out.head, i);
        append(out.head, frame.time_us);
        append(out.head, frame.sequence);
        append(out.head, std::uint32_t{frame.key});
        ask_for_more(stream);
        return out;
    }
    return std::nullopt;
}

// ---- nodes ----

void StreamHub::start(const Key& key, NodeStream& stream) {
    proto::StreamStart message;
    message.set_stream(stream.id.value);
    message.set_slot(key.slot);
    message.set_session(key.session.value);
    message.set_surface(key.surface.value);
    auto& crop = *message.mutable_crop();
    crop.set_x(key.x);
    crop.set_y(key.y);
    crop.set_width(static_cast<std::uint32_t>(key.crop_width));
    crop.set_height(static_cast<std::uint32_t>(key.crop_height));
    message.set_codec(key.codec);
    message.set_output(key.output);
    message.set_width(key.width);
    message.set_height(key.height);
    message.set_interval_us(1'000'000 / key.fps);
    stream.on_its_way = true;
    stream.header.reset();
    stream.coming.reset();
    out_.to_node(key.node, make(&proto::Envelope::mutable_stream_start, message));
}

/// If somebody could take a frame, and none is on its way.
void StreamHub::ask_for_more(Streams::value_type& entry) {
    auto& [key, stream] = entry;
    bool wanted = false, want_key = false;
    for (const auto& place : stream.watchers) {
        const Part& part = at(place);
        wanted |= !part.frame;
        want_key |= part.needs_key && !part.frame;
    }
    if (!wanted || !wall_.nodes()[key.node].up || (stream.on_its_way && !want_key)) return;
    stream.on_its_way = true;
    proto::StreamReady ready;
    ready.set_stream(stream.id.value);
    ready.set_key(want_key);
    out_.to_node(key.node, make(&proto::Envelope::mutable_stream_ready, ready));
}

void StreamHub::arrived(NodeIndex node, proto::StreamFrame& frame) {
    const auto found = by_id_.find(PictureId(frame.stream()));
    if (found == by_id_.end() || found->second->first.node != node) return;
    auto& stream = found->second->second;
    if (!frame.error().empty()) return end(stream, frame.error());
    const auto whole = add_part(stream, frame);
    if (!whole) return end(stream, whole.error().message);
    if (!*whole) return;
    const Key& key = found->second->first;
    if (frame.width() != key.width || frame.height() != key.height)
        return end(stream, fmt::format("{}x{} pixels came, not {}x{}: do walld and the node read the same wall.toml?",
                                       frame.width(), frame.height(), key.width, key.height));
    if (!stream.header) {
        if (!frame.key()) return ask_for_more(*found->second);
        note_header(stream, frame);
    }
    ++counters_.frames;
    ++stream.frames;
    counters_.bytes += frame.packet().size();
    stream.bytes += frame.packet().size();
    stream.on_its_way = false;
    deliver(stream, {++stream.sequence, frame.time_us(), frame.key(),
                     std::make_shared<const std::string>(std::move(*frame.mutable_packet()))});
    ask_for_more(*found->second);
}

/// True: `frame` is whole now. Frames of a stream come one after the other, each in parts in order.
Result<bool> StreamHub::add_part(NodeStream& stream, proto::StreamFrame& frame) {
    auto& coming = stream.coming;
    if (frame.offset() == 0 && frame.packet().size() >= frame.packet_bytes()) {
        coming.reset();
        return true;
    }
    const bool first = frame.offset() == 0;
    const bool fits =
        frame.packet_bytes() <= kMaxPacket && frame.offset() + frame.packet().size() <= frame.packet_bytes();
    if (!fits || (!first && (!coming || coming->packet_bytes() != frame.packet_bytes() ||
                             coming->packet().size() != frame.offset()))) {
        coming.reset();
        return fail("the node's parts of a frame do not fit together");
    }
    if (first) {
        coming = std::move(frame);
        coming->mutable_packet()->reserve(coming->packet_bytes());
        return false;
    }
    coming->mutable_packet()->append(frame.packet());
    if (coming->packet().size() < coming->packet_bytes()) return false;
    frame = std::move(*coming);
    coming.reset();
    return true;
}

void StreamHub::note_header(NodeStream& stream, const proto::StreamFrame& frame) {
    stream.header = net::to_base64(frame.header());
    for (const auto& place : stream.watchers) at(place).announced = false;
}

StreamHub::Part& StreamHub::at(const Place& place) { return place.viewer->watches_[place.stream].parts[place.part]; }

void StreamHub::deliver(NodeStream& stream, const Frame& frame) {
    for (const auto& place : stream.watchers) {
        Part& part = at(place);
        if (part.frame) ++counters_.dropped, ++stream.dropped;
        // A difference needs the frame that waits, so that one stays, and a key frame must follow it.
        if (!frame.key && part.frame) part.needs_key = true;
        if (!frame.key && part.needs_key) continue;
        part.frame = frame;
        part.needs_key = false;
        place.viewer->news_.notify();
    }
}

void StreamHub::end(NodeStream& stream, const std::string& why) {
    stream.on_its_way = false;
    stream.header.reset();
    stream.coming.reset();
    for (const auto& place : stream.watchers) {
        Part& part = at(place);
        part.announced = false;
        part.needs_key = true;
        part.frame.reset();
        part.ended = why;
        place.viewer->news_.notify();
    }
}

std::vector<StreamView> StreamHub::views() const {
    std::vector<StreamView> out;
    for (const auto& [key, stream] : streams_) {
        const auto* const found = wall_.nodes()[key.node].config->tile(key.slot);
        if (!found) continue;
        const auto& tile = *found;
        const geom::Rect crop{key.x, key.y, key.crop_width, key.crop_height},
            whole = key.output ? geom::Rect{0, 0, tile.output.width, tile.output.height}
                               : geom::Rect{0, 0, tile.rect.width, tile.rect.height};
        out.push_back({stream.id, key.node, tile.name, key.codec, key.session, key.surface,
                       crop == whole ? geom::Rect{} : crop, key.output, key.width, key.height, key.fps,
                       stream.watchers.size(), stream.frames, stream.bytes, stream.dropped});
    }
    return out;
}

void StreamHub::node_joined(NodeIndex node) {
    for (auto& [key, stream] : streams_)
        if (key.node == node) start(key, stream);
}

void StreamHub::node_left(NodeIndex node) {
    for (auto& [key, stream] : streams_)
        if (key.node == node) end(stream, "node " + wall_.nodes()[node].config->name + " is away");
}

}  // namespace wall::walld
