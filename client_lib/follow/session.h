// SPDX-License-Identifier: MIT
// One process on the wall: its link to walld, its nodes with a mirror of what each holds, its surfaces. Every node is a
// follower of the process's contexts, some logical time behind; `Node` holds how far behind (DESIGN, section 1).
//
// Application threads. The session's mutex guards everything in here; public functions take it, `Node&` arguments mean
// that the caller holds it.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "client_lib/context/core.h"
#include "client_lib/follow/ideal.h"
#include "client_lib/follow/sync_objects.h"
#include "client_lib/geometry/needs.h"
#include "client_lib/geometry/router.h"
#include "client_lib/link/connect_attempt.h"
#include "client_lib/link/control.h"
#include "client_lib/link/node_stream.h"
#include "client_lib/link/parallel.h"
#include "client_lib/link/reopening.h"
#include "client_lib/link/transport.h"
#include "client_lib/objects/object.h"
#include "client_lib/process/stats.h"
#include "common/base/ids.h"
#include "common/glstate/value_history.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

class Context;
class KeptFrame;
struct HiddenPart;   // hidden_part.h
struct SortScratch;  // block_sender.h

/// Of a window: in a parallel program the same in all members, which open their windows in the same order; 0: too many.
SurfaceId next_window_id();

/// Logical times, by object.
using ObjectStamps = std::unordered_map<ClientName, std::uint64_t>;

/// What a node holds of one context.
struct Mirror {
    glstate::State state;
    glstate::ValueHistory history;
    SurfaceId draw_surface, read_surface;
    UseStamp used;  ///< as of when the node was last brought what drawing with the context needs
};

/// One tileserver as this process sees it.
struct Node {
    NodeIndex index;
    std::string name;
    NodeInfo info;
    std::shared_ptr<NodeStream> stream;                     ///< null: not connected
    std::unordered_map<ContextId, Mirror> mirrors;          ///< by context
    ObjectStamps object_stamps;                             ///< of what the node has; absent: nothing
    std::unordered_map<SurfaceId, std::uint32_t> surfaces;  ///< by surface: layout version it knows
    std::unordered_map<SurfaceId, std::uint32_t>
        left_out;                             ///< surfaces whose frames it does not get now: the last one it got
    bool asks_unanswered = false;             ///< a question about content took too long: it gets no more
    bool slow = false;                        ///< missed a frame's limit; not waited for until it answers again
    std::shared_ptr<ConnectAttempt> attempt;  ///< one that is being made
    Reopening reopening;

    wire::PackBuffer batch;   ///< being packed
    ContextId batch_context;  ///< whose

    bool alive() const { return stream && !stream->failed(); }
    /// Whether drawing into the surface goes to it.
    bool takes(SurfaceId surface) const { return alive() && (left_out.empty() || !left_out.contains(surface)); }
    /// Whether it can be expected to answer soon.
    bool answers() const { return alive() && left_out.empty(); }
};

class ClientSurface {
public:
    ClientSurface(SurfaceId own_id, SurfaceOptions own_options);
    ~ClientSurface();
    const SurfaceId id;
    const SurfaceOptions options;
    SurfaceLayout layout;
    std::uint32_t frame = 0;             ///< of the last swap
    bool opened = false;                 ///< walld knows it
    bool drawn = false;                  ///< something was drawn since the last swap
    std::optional<Placement> next;       ///< from walld, for a frame that begins
    bool cleared = false;                ///< all of its back buffer, since the last swap
    bool depth_images = false;           ///< depth or stencil was drawn as an image
    std::unique_ptr<HiddenPart> hidden;  ///< what no tile shows; null: nothing
    // In a parallel program.
    std::deque<Placement> coming;  ///< for frames that have not begun, in order
    Extent window;                 ///< of this process's own window, as walld was told
};

class ClientSession {
public:
    /// The process's session; made at the first call. Null if the wall cannot be reached (said once on stderr).
    static std::shared_ptr<ClientSession> get();
    /// Sends what is packed, and waits a moment until it is on its way. At the end of the process.
    void finish();
    /// The same, but never makes one: null if no context holds it.
    static std::shared_ptr<ClientSession> get_if_open();
    ~ClientSession();

    const Caps& caps() const { return control_->welcome().caps; }

    void open_surface(ClientSurface& surface);
    void close_surface(ClientSurface& surface);
    /// Adopts what changed since the last frame: placements, nodes that came or went, the window's size. Called where
    /// a frame begins, so that culling and drawing of one frame agree on one layout.
    void begin_frame(ClientSurface& surface);
    /// Ends a frame on every node that shows the surface.
    void swap(Context* context, ClientSurface& surface);

    /// Sends the block that the context's packer holds to the nodes that it touches.
    void submit_block(Context& context);
    /// Runs `pack` inside a Block on every target that `box` touches (nothing: all of them).
    template <class Pack>
    void draw(Context& context, const std::optional<PixelRect>& box, const Needs& needs, Pack&& pack);
    /// The same after `before(node, buffer)` outside of the Block; `after(node)` when it is packed.
    template <class Before, class Pack, class After>
    void draw(Context& context, const std::optional<PixelRect>& box, const Needs& needs, Before&& before, Pack&& pack,
              After&& after);
    /// Runs `pack(buffer, node)` outside of blocks on every node, with nothing brought up to date.
    template <class Pack>
    void on_every_node(Context& context, Pack&& pack);

    /// Tells every node that holds an object that it is gone, by its kind's command.
    void delete_object(Context& context, ClientName object, void (*pack)(wire::PackBuffer&, ClientName));

    /// Packs a command that wants an answer, `pack(buffer, request)`, behind everything that drawing with the context
    /// needs, sends it and waits. Nothing if the node is lost. `function`: for the count of round trips.
    template <class Pack>
    std::optional<std::vector<std::byte>> ask(Context& context, Node& node, const char* function, Pack&& pack);

    /// The same for several targets of the read surface, `pack(buffer, request, i)`: all are asked before the first
    /// answer is waited for, so it is one round trip. An answer for each target in order; nothing where a node is lost.
    template <class Pack>
    std::vector<std::optional<std::vector<std::byte>>> ask_all(Context& context, const std::vector<Target>& targets,
                                                               const char* function, Pack&& pack);

    /// Everything queued goes out; `wait` also waits until all nodes have executed it.
    void flush(Context* context, bool wait);
    /// A command of GL_CR_synchronization. `note(SyncObjects&)` gives its OpenGL error; if there is none,
    /// `pack(buffer)` says it to all nodes, behind everything before it. `at_once`: others may wait for it, or the
    /// stream is held behind it.
    template <class Note, class Pack>
    void synchronize(Context& context, bool at_once, Note&& note, Pack&& pack);
    void destroy_context(ContextId context);

    // ---- the part of a window that no tile shows (session_hidden.cpp) ----
    /// Before pixels of a rectangle of the window are asked for (window pixels, origin bottom left).
    void look_at_hidden(ClientSurface& surface, const geom::Rect& box);
    /// Before the samples of a query are.
    void count_hidden_samples();
    /// Before glAccum: its buffer goes on from frame to frame.
    void accumulate_hidden(ClientSurface& surface);
    /// Before a clear, with glClear's mask.
    void clear_hidden(Context& context, std::uint32_t mask);
    /// Before a texture, program or run that has been drawn with changes or goes.
    void before_object_changes(ClientName object);

    // ---- with the mutex held ----
    /// What follows a block that is kept; null: it is not (and `context`'s layout may have changed). The draw surface
    /// has a hidden part.
    Node* begin_keeping(Context& context, const std::optional<PixelRect>& box);
    /// The same as prepare(), after begin_keeping().
    wire::PackBuffer& prepare_kept(Context& context, const Needs& needs);
    std::mutex& mutex() { return mutex_; }
    std::vector<std::unique_ptr<Node>>& nodes() { return nodes_; }
    /// The node's batch, set to this context (earlier commands of another one are sent first).
    wire::PackBuffer& batch(Node& node, ContextId context);
    /// The node's batch after everything that drawing with this context needs: surfaces, objects, state.
    wire::PackBuffer& prepare(Node& node, Context& context, const Needs& needs = {});
    void send(Node& node);
    /// Packs a question, `pack(buffer, request)`, into the node's batch, sends it and waits for `limit_ms` with the
    /// mutex held.
    template <class Pack>
    std::optional<std::vector<std::byte>> ask_now(Node& node, const char* function, int limit_ms, Pack&& pack) {
        const RequestId request = next_request();
        pack(node.batch, request);
        count_round_trip(function);
        send(node);
        return node.stream->wait_reply(request, limit_ms);
    }
    Node& node_of(NodeIndex index) { return *nodes_[index.value]; }
    Node& node_of(const Target& target) { return node_of(target.node); }
    void count_geometry(Node& node, std::size_t bytes);
    void count_block(Node& node);
    void count_objects(Node& node, std::size_t bytes);
    void count_state(Node& node, std::size_t bytes);

private:
    friend class BlockSender;
    /// For what is queued when a member of a parallel program ends: the others wait for it.
    static constexpr int kLeaveLimitMs = 2000;
    explicit ClientSession(std::unique_ptr<ControlLink> control);
    void adopt(const Welcome& welcome);
    void apply_layout(ClientSurface& surface, const Placement& placement);
    void take_events();
    bool in_frame(const ClientSurface& surface) const { return surface.drawn && surface.frame > 0; }
    void adopt_placement(ClientSurface& surface);
    void follow_window(ClientSurface& surface);
    void connect(Node& node);
    void attempt(Node& node);
    /// Until what connect() has begun since the last call has come to something, at most `limit`; the lock is not held
    /// meanwhile.
    void wait_for_attempts(std::unique_lock<std::mutex>& lock, std::chrono::milliseconds limit);
    void take_attempt(Node& node);
    void adopt_stream(Node& node, Result<std::shared_ptr<NodeStream>> stream);
    void lose(Node& node);
    void forget(Node& node);
    void keep_connected(Node& node);
    void place_off_wall();
    void redraw();
    void describe_surface(Node& node, ClientSurface& surface);
    Node& node_at(NodeIndex index);
    Node& node_slot(const NodeInfo& info);
    std::vector<NodeIndex> swap_nodes(const ClientSurface& surface) const;
    int reply_timeout_ms() const;
    void wait_for_nodes(ClientSurface& surface, bool whole_frames);
    /// Runs `body` with the mutex held. Where it throws, batches and mirrors may be half made: the nodes' streams fail
    /// then, so that every node begins again at time zero.
    template <class Body>
    decltype(auto) packing(Body&& body) {
        std::lock_guard lock(mutex_);
        try {
            return std::forward<Body>(body)();
        } catch (...) {
            distrust_nodes();
            throw;
        }
    }
    void distrust_nodes();
    void lay_hidden_part(ClientSurface& surface);
    void lay_hidden_parts();
    std::optional<NodeIndex> node_for_hidden(const ClientSurface& surface, std::optional<NodeIndex> before);
    void finish_hidden_frame(ClientSurface& surface);
    void note_hidden_frame(ClientSurface& surface, bool whole);
    void rest_hidden(ClientSurface& surface);
    void show_hidden(ClientSurface& surface);
    void send_kept(Node& node, ClientSurface& surface, KeptFrame& frame);
    void before_context_goes(ContextId context);
    RequestId next_request() { return last_request_ = RequestId(last_request_.value + 1); }
    void count_frame();
    void count_round_trip(const char* function);

    // ---- of a parallel program (session_group.cpp) ----
    void introduce(Node& node);
    void adopt_agreed(ClientSurface& surface);
    void use_node(const NodeInfo& info);
    void report_window(ClientSurface& surface);
    void wait_for_group(ClientSurface& surface);
    void leave_group();
    bool common(const ClientSurface& surface) const { return group_ && surface.options.visible; }

    const std::optional<Parallel>& group_ = parallel();
    SyncObjects sync_{group_ ? group_->members : 1};
    std::unique_ptr<ControlLink> control_;
    Transport transport_{[this] {
        if (!group_) control_->ask_all_to_redraw();  // the program's next frame opens the stream again
    }};
    std::mutex mutex_;
    bool attempts_begun_ = false;  ///< by connect(), since wait_for_attempts()
    std::vector<std::unique_ptr<Node>> nodes_;
    std::unordered_map<SurfaceId, ClientSurface*> surfaces_;
    SessionId id_;
    std::vector<TileInfo> tiles_;
    RequestId last_request_;
    const std::unique_ptr<SortScratch> sort_scratch_;
    IdealTraffic ideal_;          ///< unused without WALLGL_IDEAL
    std::uint32_t prepared_ = 0;  ///< counts towards the next sample of the diff time
};

/// The part of the surface's window that shows in `part` of the canvas.
Target make_target(const SurfaceLayout& layout, const TileInfo& tile, const geom::Rect& part);

}  // namespace wall::client
