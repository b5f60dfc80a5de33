// SPDX-License-Identifier: MIT
// Who watches what, and the frames on their way from nodes to viewers (docs/streams.md). A viewer's stream has a part
// for each tile that it takes; each part is a stream of the tile's node, which all viewers share that want the same.
// For each viewer and part at most one frame waits; a newer one takes its place. A node makes the next frame when the
// first viewer has taken the last one, so that nobody slow holds anybody, and nothing is made that nobody can take. One
// thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/daemon/changed.h"
#include "walld/streams/stream_scope.h"
#include "walld/wall/quota.h"

namespace wall::walld {

namespace asio = boost::asio;

/// A message for one viewer.
struct ViewerMessage {
    bool binary = false;
    std::string head;                           ///< all of it, or what comes before the packet
    std::shared_ptr<const std::string> packet;  ///< shared by all viewers; may be null
};

/// One stream of a node, as an operator sees it.
struct StreamView {
    PictureId id;  ///< in the node's messages
    NodeIndex node;
    std::string tile, codec;
    SessionId session;    ///< none: all
    SurfaceId surface;    ///< none: all of the session
    geom::Rect crop;      ///< of the tile; all of it: empty
    bool output = false;  ///< what the tile's output shows; `crop` is in its pixels
    std::uint32_t width = 0, height = 0, fps = 0;
    std::size_t viewers = 0;
    std::uint64_t frames = 0, bytes = 0, dropped = 0;  ///< that have come since it was started; as StreamHub::Counters
};

class StreamHub {
public:
    static constexpr std::size_t kMaxNodeStreams = 1024;                 ///< of the wall
    static constexpr std::size_t kMaxStreamsOfOne = 512;                 ///< of those that one person watches
    static constexpr std::size_t kMaxPartsOfViewer = 1024;               ///< in all that a viewer watches
    static constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;  ///< of a picture of each of the wall's

    class Viewer;

    StreamHub(asio::any_io_executor executor, const Wall& wall, Outbox& out)
        : executor_(std::move(executor)), wall_(wall), out_(out) {}

    /// Refused when there are as many viewers as there may be. Is to be removed in the end.
    Outcome<std::shared_ptr<Viewer>> add_viewer(const Person& who);
    void remove_viewer(Viewer& viewer);
    /// Replaces what the viewer watched; on an error it goes on with that.
    Result<void> watch(Viewer& viewer, const std::vector<WatchRequest>& requests);
    /// The next message for the viewer; nothing if there is none yet (wait for viewer.news()).
    std::optional<ViewerMessage> next(Viewer& viewer);

    void node_joined(NodeIndex node);
    void node_left(NodeIndex node);
    void arrived(NodeIndex node, proto::StreamFrame& frame);
    /// The wall has other tiles: everything that is watched is found anew among them.
    void wall_changed(Clock::time_point now);
    /// To be called after any change of the wall: streams of windows follow them, at their rate.
    void tick(Clock::time_point now);
    /// When tick() has to be called even if nothing changes.
    std::optional<Clock::time_point> next_deadline() const { return deadline_; }

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
        std::uint32_t slot;
        SessionId session;
        SurfaceId surface;
        std::int32_t x, y, crop_width, crop_height;
        std::string codec;
        std::uint32_t width, height, fps;
        bool output;
        auto operator<=>(const Key&) const = default;
        std::uint64_t pixels() const { return std::uint64_t{width} * height; }
    };
    struct Frame {
        std::uint32_t sequence = 0;
        std::uint64_t time_us = 0;
        bool key = false;
        std::shared_ptr<const std::string> packet;
    };
    /// A part of a viewer's stream: the place in its list of streams, and in the stream.
    struct Place {
        Viewer* viewer;
        std::uint32_t stream, part;
        auto operator<=>(const Place&) const = default;
    };
    struct NodeStream {
        PictureId id;
        std::optional<std::string> header;  ///< the codec's; none: no frame yet
        std::uint32_t sequence = 0;
        bool on_its_way = true;  ///< the node was asked for a frame that has not come
        std::uint64_t frames = 0, bytes = 0, dropped = 0;
        std::set<Place> watchers;
        std::optional<proto::StreamFrame> coming;  ///< of which parts are still to come
    };
    struct Part;
    struct Watch;

    using Streams = std::map<Key, NodeStream>;
    std::string tile_name(const Key& key) const;
    Watch make_watch(const WatchRequest& request, const StreamScope& scope) const;
    std::set<Key> watched_by(const std::string& who, std::span<const Watch> but) const;
    Result<void> check_room(const Viewer& viewer, std::span<const Watch> watches,
                            std::span<const Watch> instead_of) const;
    static Result<bool> add_part(NodeStream& stream, proto::StreamFrame& frame);
    std::vector<Key> leave(Viewer& viewer, std::uint32_t number);
    void join(Viewer& viewer, std::uint32_t number);
    void drop_unwatched(const std::vector<Key>& keys);
    void follow(Viewer& viewer, std::uint32_t number, Clock::time_point now);
    bool find_anew(Viewer& viewer, std::uint32_t number, const Result<StreamScope>& scope);
    std::optional<ViewerMessage> next_of(Viewer& viewer, std::uint32_t number);
    std::string parts_text(std::uint32_t number, const Watch& watch) const;
    static Part& at(const Place& place);
    void start(const Key& key, NodeStream& stream);
    void ask_for_more(Streams::value_type& stream);
    void note_header(NodeStream& stream, const proto::StreamFrame& frame);
    void deliver(NodeStream& stream, const Frame& frame);
    void end(NodeStream& stream, const std::string& why);

    asio::any_io_executor executor_;
    const Wall& wall_;
    Outbox& out_;
    Streams streams_;
    std::map<PictureId, Streams::iterator> by_id_;
    Quota places_{kViewers};
    std::map<Viewer*, std::shared_ptr<Viewer>> viewers_;
    PictureId last_id_;
    std::optional<Clock::time_point> deadline_;
    Counters counters_;
};

struct StreamHub::Part {
    Key key;
    geom::Rect at;               ///< in the picture
    bool announced = false;      ///< the viewer has the codec's header
    bool needs_key = true;       ///< after the frame that waits
    std::optional<Frame> frame;  ///< that waits
    std::string ended;           ///< why there is nothing more, until the viewer was told
};

struct StreamHub::Watch {
    WatchRequest request;
    std::optional<StreamScope> scope;  ///< none: there is no such window any more
    std::vector<Part> parts;
    bool told = false;               ///< the viewer knows the parts
    std::string ended;               ///< why there is no scope, until the viewer was told
    Clock::time_point not_before{};  ///< when it may follow its window again
    std::uint32_t turn = 0;          ///< the part that is looked at first, for fairness
};

/// One connection's place in the hub.
class StreamHub::Viewer {
public:
    Viewer(const asio::any_io_executor& executor, std::string who, Quota::Place place)
        : news_(executor), who_(std::move(who)), place_(std::move(place)) {}
    /// Notified when next() may have something.
    net::Changed& news() { return news_; }
    /// Says that a message made no sense; the last such answer is enough.
    void tell_error(const std::string& what);

private:
    friend class StreamHub;
    net::Changed news_;
    std::string who_;
    Quota::Place place_;
    std::vector<Watch> watches_;
    std::string error_;
    std::uint32_t turn_ = 0;  ///< the stream that is looked at first, for fairness
};

}  // namespace wall::walld
