// SPDX-License-Identifier: MIT
#include "walld/stream_hub.h"

#include <nlohmann/json.hpp>

#include "common/codec/codec.h"
#include "common/net/base64.h"
#include "walld/messages.h"

namespace wall::walld {
namespace {

using nlohmann::json;

template <class T>
void append(std::string& out, T value) {
    for (std::size_t i = 0; i < sizeof value; ++i) out += static_cast<char>(value >> 8 * i & 0xff);
}

/// An integer from `least` to `most`, `otherwise` if it is not there.
Result<std::uint32_t> number(const json& from, const char* key, std::uint32_t least, std::uint32_t most, std::uint32_t otherwise) {
    const auto at = from.find(key);
    if (at == from.end()) return otherwise;
    if (at->is_number_integer() && at->get<std::int64_t>() >= least && at->get<std::int64_t>() <= most) return at->get<std::uint32_t>();
    return fail(std::string(".") + key + ": expected a whole number from " + std::to_string(least) + " to " + std::to_string(most));
}

Result<std::string> text(const json& from, const char* key, const std::string& otherwise) {
    const auto at = from.find(key);
    if (at == from.end() && !otherwise.empty()) return otherwise;
    if (at != from.end() && at->is_string() && !at->get_ref<const std::string&>().empty()) return at->get<std::string>();
    return fail(std::string(".") + key + ": expected a text");
}

Result<WatchRequest> one_request(const json& from) {
    if (!from.is_object()) return fail(": expected an object");
    const auto tile = text(from, "tile", ""), codec = text(from, "codec", WatchRequest{}.codec);
    const auto session = number(from, "session", 1, UINT32_MAX, 0), fps = number(from, "fps", 1, StreamHub::kMaxFps, WatchRequest{}.fps);
    const auto width = number(from, "width", 1, codec::kMaxExtent, 0), height = number(from, "height", 1, codec::kMaxExtent, 0);
    for (const auto* wrong : {&tile, &codec})
        if (!*wrong) return tl::unexpected(wrong->error());
    for (const auto* wrong : {&session, &fps, &width, &height})
        if (!*wrong) return tl::unexpected(wrong->error());
    if (const auto known = codec::find_codec(*codec); !known) return fail(".codec: " + known.error().message);
    return WatchRequest{*tile, SessionId(*session), *codec, *width, *height, *fps};
}

}  // namespace

Result<std::vector<WatchRequest>> WatchRequest::parse(std::string_view message) {
    const auto parsed = json::parse(message, nullptr, false);
    if (!parsed.is_object() || !parsed.contains("watch") || !parsed["watch"].is_array()) return fail("expected {\"watch\": [...]}");
    if (parsed["watch"].size() > StreamHub::kMaxWatches) return fail("watch: expected at most " + std::to_string(StreamHub::kMaxWatches) + " streams");
    std::vector<WatchRequest> out;
    for (const auto& item : parsed["watch"]) {
        auto request = one_request(item);
        if (!request) return fail("watch[" + std::to_string(out.size()) + "]" + request.error().message);
        out.push_back(std::move(*request));
    }
    return out;
}

// ---- viewers ----

void StreamHub::Viewer::tell_error(const std::string& what) {
    error_ = what;
    news_.notify();
}

std::shared_ptr<StreamHub::Viewer> StreamHub::add_viewer() {
    auto viewer = std::make_shared<Viewer>(executor_);
    viewers_[viewer.get()] = viewer;
    return viewer;
}

void StreamHub::remove_viewer(Viewer& viewer) {
    for (std::uint32_t i = 0; i < viewer.watches_.size(); ++i) leave(viewer, i);
    viewer.watches_.clear();
    viewers_.erase(&viewer);
}

Result<StreamHub::Key> StreamHub::key_of(const WatchRequest& request, std::size_t number) const {
    for (NodeIndex node = 0; node < wall_.nodes().size(); ++node) {
        for (std::uint32_t slot = 0; const auto& tile : wall_.nodes()[node].config->tiles) {
            const auto this_slot = slot++;
            if (tile.name != request.tile) continue;
            const auto fitting = [](std::uint32_t wanted, std::int32_t most) { return wanted == 0 ? static_cast<std::uint32_t>(most) : std::min(wanted, static_cast<std::uint32_t>(most)); };
            return Key{node, this_slot, request.session.value, request.codec, fitting(request.width, tile.rect.width), fitting(request.height, tile.rect.height), request.fps};
        }
    }
    return fail("watch[" + std::to_string(number) + "].tile: there is no tile '" + request.tile + "'");
}

Result<void> StreamHub::watch(Viewer& viewer, const std::vector<WatchRequest>& requests) {
    std::vector<Key> keys;
    std::set<Key> fresh;
    for (const auto& request : requests) {
        auto key = key_of(request, keys.size());
        if (!key) return tl::unexpected(key.error());
        if (!streams_.contains(*key)) fresh.insert(*key);
        keys.push_back(std::move(*key));
    }
    if (streams_.size() + fresh.size() > kMaxNodeStreams) return fail("watch: the wall's " + std::to_string(kMaxNodeStreams) + " streams are all in use");
    // What stays must not end and begin anew on the node: join first.
    const auto before = std::exchange(viewer.watches_, {});
    std::vector<std::pair<Key, std::uint32_t>> old;
    for (std::uint32_t i = 0; i < before.size(); ++i) old.emplace_back(before[i].key, i);
    viewer.watches_.resize(keys.size());
    for (const auto& [key, number] : old) streams_.at(key).watchers.erase({&viewer, number});
    for (std::uint32_t i = 0; i < keys.size(); ++i) join(viewer, i, keys[i]);
    for (const auto& [key, number] : old) {
        const auto at = streams_.find(key);
        if (at == streams_.end() || !at->second.watchers.empty()) continue;
        proto::StreamStop stop;
        stop.set_stream(at->second.id);
        out_.to_node(key.node, make(&proto::Envelope::mutable_stream_stop, stop));
        by_id_.erase(at->second.id);
        streams_.erase(at);
    }
    viewer.news_.notify();
    return {};
}

void StreamHub::join(Viewer& viewer, std::uint32_t number, const Key& key) {
    viewer.watches_[number] = Watch{key, false, true, std::nullopt, {}};
    const auto [at, fresh] = streams_.try_emplace(key);
    at->second.watchers.emplace(&viewer, number);
    if (!fresh) return ask_for_more(*at);  // an unchanged picture would never come by itself
    at->second.id = ++last_id_;
    at->second.tile = wall_.nodes()[key.node].config->tiles[key.slot].name;
    by_id_[at->second.id] = at;
    if (wall_.nodes()[key.node].up) start(key, at->second);
}

void StreamHub::leave(Viewer& viewer, std::uint32_t number) {
    const auto at = streams_.find(viewer.watches_[number].key);
    if (at == streams_.end()) return;
    at->second.watchers.erase({&viewer, number});
    if (!at->second.watchers.empty()) return ask_for_more(*at);  // it may have been the one that was waited for
    proto::StreamStop stop;
    stop.set_stream(at->second.id);
    out_.to_node(at->first.node, make(&proto::Envelope::mutable_stream_stop, stop));
    by_id_.erase(at->second.id);
    streams_.erase(at);
}

std::optional<ViewerMessage> StreamHub::next(Viewer& viewer) {
    if (!viewer.error_.empty()) return ViewerMessage{false, json{{"error", std::exchange(viewer.error_, {})}}.dump(), nullptr};
    const auto count = static_cast<std::uint32_t>(viewer.watches_.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t i = (viewer.turn_ + k) % count;
        Watch& watch = viewer.watches_[i];
        if (!watch.ended.empty()) return ViewerMessage{false, json{{"stream", i}, {"ended", std::exchange(watch.ended, {})}}.dump(), nullptr};
        if (!watch.frame) continue;
        auto& stream = *streams_.find(watch.key);
        if (!watch.announced) {
            watch.announced = true;
            return ViewerMessage{false, "{\"stream\": " + std::to_string(i) + ", " + stream.second.format + "}", nullptr};
        }
        viewer.turn_ = i + 1;
        const Frame frame = *std::exchange(watch.frame, std::nullopt);
        ViewerMessage out{true, {}, frame.packet};
        append(out.head, i);
        append(out.head, frame.sequence);
        append(out.head, frame.time_us);
        append(out.head, std::uint32_t{frame.key});
        ask_for_more(stream);
        return out;
    }
    return std::nullopt;
}

// ---- nodes ----

void StreamHub::start(const Key& key, NodeStream& stream) {
    proto::StreamStart message;
    message.set_stream(stream.id);
    message.set_slot(key.slot);
    message.set_session(key.session);
    message.set_codec(key.codec);
    message.set_width(key.width);
    message.set_height(key.height);
    message.set_interval_us(1'000'000 / key.fps);
    stream.on_its_way = true;
    stream.format.clear();
    out_.to_node(key.node, make(&proto::Envelope::mutable_stream_start, message));
}

/// If somebody could take a frame, and none is on its way.
void StreamHub::ask_for_more(Streams::value_type& entry) {
    auto& [key, stream] = entry;
    bool wanted = false, want_key = false;
    for (const auto& [viewer, number] : stream.watchers) {
        const Watch& watch = viewer->watches_[number];
        wanted |= !watch.frame;
        want_key |= watch.needs_key && !watch.frame;
    }
    if (!wanted || !wall_.nodes()[key.node].up || (stream.on_its_way && !want_key)) return;
    stream.on_its_way = true;
    proto::StreamReady ready;
    ready.set_stream(stream.id);
    ready.set_key(want_key);
    out_.to_node(key.node, make(&proto::Envelope::mutable_stream_ready, ready));
}

void StreamHub::arrived(NodeIndex node, proto::StreamFrame& frame) {
    const auto found = by_id_.find(frame.stream());
    if (found == by_id_.end() || found->second->first.node != node) return;
    auto& stream = found->second->second;
    if (!frame.error().empty()) return end(stream, frame.error());
    const bool same_size = frame.width() == stream.width && frame.height() == stream.height;
    if (stream.format.empty() || !same_size) {
        if (!frame.key()) return ask_for_more(*found->second);
        note_format(found->second->first, stream, frame);
    }
    ++counters_.frames;
    ++stream.frames;
    counters_.bytes += frame.packet().size();
    stream.bytes += frame.packet().size();
    stream.on_its_way = false;
    deliver(stream, {++stream.sequence, frame.time_us(), frame.key(), std::make_shared<const std::string>(std::move(*frame.mutable_packet()))});
    ask_for_more(*found->second);
}

void StreamHub::note_format(const Key& key, NodeStream& stream, const proto::StreamFrame& frame) {
    const json format{{"tile", stream.tile}, {"codec", key.codec}, {"width", frame.width()}, {"height", frame.height()}, {"layout", "rgba"}, {"header", net::to_base64(frame.header())}};
    const std::string text = format.dump();
    stream.format = text.substr(1, text.size() - 2);
    stream.width = frame.width();
    stream.height = frame.height();
    for (const auto& [viewer, number] : stream.watchers) viewer->watches_[number].announced = false;
}

void StreamHub::deliver(NodeStream& stream, const Frame& frame) {
    for (const auto& [viewer, number] : stream.watchers) {
        Watch& watch = viewer->watches_[number];
        if (watch.frame) ++counters_.dropped, ++stream.dropped;
        // A difference needs the frame that waits, so that one stays, and a key frame must follow it.
        if (!frame.key && watch.frame) watch.needs_key = true;
        if (!frame.key && watch.needs_key) continue;
        watch.frame = frame;
        watch.needs_key = false;
        viewer->news_.notify();
    }
}

void StreamHub::end(NodeStream& stream, const std::string& why) {
    stream.on_its_way = false;
    stream.format.clear();
    for (const auto& [viewer, number] : stream.watchers) {
        Watch& watch = viewer->watches_[number];
        watch.announced = false;
        watch.needs_key = true;
        watch.frame.reset();
        watch.ended = why;
        viewer->news_.notify();
    }
}

std::vector<StreamView> StreamHub::views() const {
    std::vector<StreamView> out;
    for (const auto& [key, stream] : streams_)
        out.push_back({stream.id, key.node, stream.tile, key.codec, SessionId(key.session), key.width, key.height, key.fps, stream.watchers.size(), stream.frames, stream.bytes, stream.dropped});
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
