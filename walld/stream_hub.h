// SPDX-License-Identifier: MIT
// Who watches which tile, and the frames on their way from nodes to viewers (docs/streams.md). Viewers that want the same
// share one stream of the node. For each viewer and stream at most one frame waits; a newer one takes its place. A node
// makes the next frame when the first viewer has taken the last one, so that nobody slow holds anybody, and nothing is
// made that nobody can take. One thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "walld/changed.h"
#include "walld/wall.h"

namespace wall::walld {

/// What a viewer asks for: a tile in some size, rate and codec.
struct WatchRequest {
    std::string tile;
    SessionId session;  ///< none: everything that the tile shows
    std::string codec = "huffyuv";
    std::uint32_t width = 0, height = 0;  ///< 0: the tile's
    std::uint32_t fps = 10;

    /// A viewer's message {"watch": [...]}. The error says what was expected, and where.
    static Result<std::vector<WatchRequest>> parse(std::string_view json);
};

/// A message for one viewer.
struct ViewerMessage {
    bool binary = false;
    std::string head;                         ///< all of it, or what comes before the packet
    std::shared_ptr<const std::string> packet;  ///< shared by all viewers; may be null
};

/// One stream of a node, as an operator sees it.
struct StreamView {
    std::uint32_t id = 0;  ///< in the node's messages
    NodeIndex node = 0;
    std::string tile, codec;
    SessionId session;     ///< none: all
    std::uint32_t width = 0, height = 0, fps = 0;
    std::size_t viewers = 0;
    std::uint64_t frames = 0, bytes = 0, dropped = 0;  ///< that have come since it was started; as StreamHub::Counters
};

class StreamHub {
public:
    static constexpr std::size_t kMaxWatches = 256;       ///< of one viewer
    static constexpr std::size_t kMaxNodeStreams = 1024;  ///< of the wall
    static constexpr std::uint32_t kMaxFps = 60;

    class Viewer;

    StreamHub(asio::any_io_executor executor, const Wall& wall, Outbox& out) : executor_(std::move(executor)), wall_(wall), out_(out) {}

    std::shared_ptr<Viewer> add_viewer();
    void remove_viewer(Viewer& viewer);
    /// Replaces what the viewer watched; on an error it goes on with that.
    Result<void> watch(Viewer& viewer, const std::vector<WatchRequest>& requests);
    /// The next message for the viewer; nothing if there is none yet (wait for viewer.news()).
    std::optional<ViewerMessage> next(Viewer& viewer);

    void node_joined(NodeIndex node);
    void node_left(NodeIndex node);
    void arrived(NodeIndex node, proto::StreamFrame& frame);

    struct Counters {
        std::uint64_t frames = 0, bytes = 0, dropped = 0;  ///< from nodes; dropped before some viewer got them
    };
    const Counters& counters() const { return counters_; }
    std::vector<StreamView> views() const;
    std::size_t viewers() const { return viewers_.size(); }
    std::size_t node_streams() const { return streams_.size(); }

private:
    struct Key {
        NodeIndex node;
        std::uint32_t slot, session;
        std::string codec;
        std::uint32_t width, height, fps;
        auto operator<=>(const Key&) const = default;
    };
    struct Frame {
        std::uint32_t sequence = 0;
        std::uint64_t time_us = 0;
        bool key = false;
        std::shared_ptr<const std::string> packet;
    };
    struct NodeStream {
        std::uint32_t id = 0;
        std::string tile;
        std::string format;  ///< JSON members of the viewers' first message; empty: no frame yet
        std::uint32_t width = 0, height = 0, sequence = 0;
        bool on_its_way = true;  ///< the node was asked for a frame that has not come
        std::uint64_t frames = 0, bytes = 0, dropped = 0;
        std::set<std::pair<Viewer*, std::uint32_t>> watchers;
    };
    struct Watch;

    using Streams = std::map<Key, NodeStream>;
    Result<Key> key_of(const WatchRequest& request, std::size_t number) const;
    void join(Viewer& viewer, std::uint32_t number, const Key& key);
    void leave(Viewer& viewer, std::uint32_t number);
    void start(const Key& key, NodeStream& stream);
    void ask_for_more(Streams::value_type& stream);
    void note_format(const Key& key, NodeStream& stream, const proto::StreamFrame& frame);
    void deliver(NodeStream& stream, const Frame& frame);
    void end(NodeStream& stream, const std::string& why);

    asio::any_io_executor executor_;
    const Wall& wall_;
    Outbox& out_;
    Streams streams_;
    std::map<std::uint32_t, Streams::iterator> by_id_;
    std::map<Viewer*, std::shared_ptr<Viewer>> viewers_;
    std::uint32_t last_id_ = 0;
    Counters counters_;
};

struct StreamHub::Watch {
    Key key;
    bool announced = false;  ///< the viewer knows the stream's format
    bool needs_key = true;       ///< after the frame that waits
    std::optional<Frame> frame;  ///< that waits
    std::string ended;           ///< why there is nothing more, until the viewer was told
};

/// One connection's place in the hub.
class StreamHub::Viewer {
public:
    explicit Viewer(const asio::any_io_executor& executor) : news_(executor) {}
    /// Notified when next() may have something.
    Changed& news() { return news_; }
    /// For a message that made no sense; the last one is enough.
    void tell_error(const std::string& what);

private:
    friend class StreamHub;
    Changed news_;
    std::vector<Watch> watches_;
    std::string error_;
    std::uint32_t turn_ = 0;  ///< the stream that is looked at first, for fairness
};

}  // namespace wall::walld
