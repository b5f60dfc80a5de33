// SPDX-License-Identifier: MIT
// The thread that owns all GL of a GPU. Other threads post to it and give it batches; it tells what happened through
// NodeEvents. Streams take turns of a batch or some milliseconds of one (Pace); a stream whose finished frame has not
// been shown yet waits before its next frame's end, while the others go on.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "tileserver/compile/compile_trials.h"
#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/caps.h"
#include "tileserver/gpu/tile_windows.h"
#include "tileserver/kms/kms_backend.h"
#include "tileserver/partials/partial_box.h"
#include "tileserver/render/batch_queue.h"
#include "tileserver/render/compositor.h"
#include "tileserver/render/running_turn.h"
#include "tileserver/render/screen_output.h"
#include "tileserver/session/parallel_group.h"
#include "tileserver/session/session_quota.h"
#include "tileserver/session/work.h"

namespace wall::tileserver {

/// Of one stream that is open.
struct SessionStats {
    SessionId session;
    Rank rank = 0;  ///< of a member of a parallel program
    Work work;
    std::size_t queued_bytes = 0;  ///< received, not yet executed
    std::uint64_t memory_bytes = 0, objects = 0;
};
struct RenderStats {
    Work work;  ///< of all sessions since the start
    std::vector<SessionStats> sessions;
    DriverObjects objects;
    std::map<std::uint32_t, std::chrono::nanoseconds> tiles;  ///< by slot: what drawing has taken, if it is measured
};

/// What the render thread reports. Called by it; must not block.
class NodeEvents {
public:
    virtual ~NodeEvents() = default;
    virtual void reply(StreamId stream, RequestId request, std::vector<std::byte> answer) = 0;
    /// For the stream's client: a frame of its is drawn.
    virtual void drawn(StreamId stream, SurfaceId surface, std::uint32_t frame) = 0;
    /// For walld; in a parallel program once for all its streams.
    virtual void rendered(SessionId session, SurfaceId surface, std::uint32_t frame) = 0;
    /// For walld: a window has drawn up to frame `drawn` and shows `shown`. The answer to report_frames().
    virtual void frames(SessionId session, SurfaceId surface, std::uint32_t drawn, std::uint32_t shown) = 0;
    /// The stream's content was bad; its session is gone from this node.
    virtual void failed(StreamId stream, SessionId session, std::string reason) = 0;
    /// Nothing was wrong with the stream itself, but it cannot go on.
    virtual void ended(StreamId stream, std::string reason) = 0;
    virtual void picture(Picture picture) = 0;
    /// For another node of the session.
    virtual void partial(SessionId session, NodeIndex to, std::vector<std::byte> message) = 0;
    /// set_tiles() is done.
    virtual void tiles_taken(std::uint32_t version) = 0;
    virtual void stats(const RenderStats& stats) = 0;  ///< about once a second
    /// Once for each tile that its screen does not show pixel for pixel.
    virtual void scaled(const ScaledTile& tile) = 0;
    /// A monitor has begun to show its tile, or has ceased to.
    virtual void monitor(const MonitorNews& news) = 0;
    /// The screens are gone, or the driver's context: nothing is drawn from then on.
    virtual void output_lost(std::string reason) = 0;
};

/// What a node's tiles are shown on: windows, or monitors, or neither.
struct ScreenRequest {
    WindowRequest windows{};
    MonitorRequest monitors{};
};

class RenderThread {
public:
    struct Started {
        GlCaps caps;
        std::string backend;
    };
    using OpenBackend = std::function<Result<std::unique_ptr<GlBackend>>()>;
    /// Makes the driver's context in the new thread, and opens the windows or monitors, if there are any; an error if
    /// there is none. `compilers`, which outlives it, for trials of shaders; null: they are compiled without limits.
    static Result<std::unique_ptr<RenderThread>> start(BackendChoice backend, NodeEvents& events,
                                                       ScreenRequest screens = {},
                                                       const CompilerHost* compilers = nullptr);
    ~RenderThread();

    /// The same on a driver that `open` gives, in the new thread.
    static Result<std::unique_ptr<RenderThread>> start(OpenBackend open, std::string name, NodeEvents& events,
                                                       const CompilerHost* compilers = nullptr);

    const Started& started() const { return started_; }

    // ---- any thread ----
    /// Nothing: no stream is being executed just now.
    std::optional<RunningTurn> running_turn() const { return board_.now(); }
    /// `rank`: of a parallel program's member.
    void add_stream(StreamId stream, SessionId session, std::shared_ptr<BatchQueue> queue,
                    const Membership& membership = {}, Rank rank = 0);
    /// Nothing more comes. The session's objects are freed; a parallel program's stream is executed to its end before,
    /// because others may wait for what it says.
    void remove_stream(StreamId stream);
    /// As remove_stream(), before its process comes with another one. What members of a parallel program had between
    /// them goes with their streams: they begin anew together.
    void replace_stream(StreamId stream);
    /// Of each of the session's streams.
    void set_quota(SessionId session, const SessionQuota& quota);
    /// All streams of the session go at once, whatever is left in them.
    void remove_session(SessionId session);
    /// Whether triangles of meshes that stay are drawn in an order that suits a GPU, where nobody sees it.
    void set_orders_triangles(bool on);
    /// `version` is told when it is done (NodeEvents::tiles_taken).
    void set_tiles(std::vector<Tile> tiles, std::uint32_t background, std::uint32_t version = 0);
    /// What drawing takes for each tile is in the stats.
    void measure_tiles(bool on);
    /// Of `held` ones no frame is shown before present(), whether or not somebody coordinates. For sessions that are
    /// `returning` nobody will say present() yet.
    void set_stacking(std::vector<StackEntry> bottom_first, std::vector<StackEntry> held = {},
                      const std::vector<SessionId>& returning = {});
    /// What the tile shows instead of programs, until set_tiles(); none: programs again.
    void set_pattern(std::uint32_t slot, std::shared_ptr<const TestPattern> pattern);
    void present(SessionId session, SurfaceId surface, std::uint32_t frame);
    /// Whether somebody will say present(); if not, frames show when they are done.
    void set_coordinated(bool coordinated);
    /// Says where the windows of a session are; without one, those of all.
    void report_frames(SessionId session);
    void request_picture(const PictureRequest& request);
    /// Pictures of a tile whenever it has changed and somebody is ready for one (TileWatch).
    void watch(const PictureRequest& request, std::chrono::microseconds interval);
    void unwatch(PictureId stream);
    void ready(PictureId stream, bool even_unchanged);
    /// Another node has sent a partial picture of one of the session's windows; the error says what is wrong with it.
    Result<void> take_partial(SessionId session, std::vector<std::byte> message);
    /// Whose partial pictures are not waited for any more, and whose are (PartialBox).
    void lose_partials(SessionId session, NodeIndex from);
    void set_partial_nodes(SessionId session, std::set<NodeIndex> nodes);
    /// A queue has got a batch.
    void wake();

private:
    class Loop;
    explicit RenderThread(NodeEvents& events) : events_(events) {}
    void run(const OpenBackend& open, std::string backend_name, const std::function<void(Result<Started>)>& started);
    void serve(Loop& loop);
    void post(std::function<void(Loop&)> task);

    NodeEvents& events_;
    Started started_;
    TurnBoard board_;
    std::mutex mutex_;  // guards the next three
    std::condition_variable wake_;
    std::vector<std::function<void(Loop&)>> tasks_;
    bool awake_ = false, stop_ = false;
    PartialBox partials_;
    std::unique_ptr<CompileTrials> trials_;  // after what it wakes
    std::thread thread_;
};

}  // namespace wall::tileserver
