// SPDX-License-Identifier: MIT
// One process on the wall: its link to walld, its nodes, its surfaces, and the one mutex that guards all that follows
// its contexts. What each part does stands with the part; here they meet.
//
// Application threads. Public functions take the mutex, but where they say that it is held.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "client_lib/follow/fence.h"
#include "client_lib/follow/followers.h"
#include "client_lib/follow/snapping.h"
#include "client_lib/follow/surfaces.h"
#include "client_lib/follow/sync_objects.h"
#include "client_lib/geometry/packer.h"
#include "client_lib/link/control.h"
#include "client_lib/link/parallel.h"
#include "common/glstate/projection.h"

namespace wall::client {

struct SortScratch;  // block_sender.h

class ClientSession {
public:
    /// The process's session; made at the first call. Null if the wall cannot be reached (said once on stderr).
    static std::shared_ptr<ClientSession> get();
    /// The same, but never makes one: null if no context holds it.
    static std::shared_ptr<ClientSession> get_if_open();
    ~ClientSession();
    /// Sends what is packed, and waits a moment until it is on its way. At the end of the process.
    void finish();

    const Caps& caps() const { return control_->welcome().caps; }

    // ---- surfaces ----
    void open_surface(ClientSurface& surface);
    void close_surface(ClientSurface& surface);
    /// Adopts what changed since the last frame: placements, nodes that came or went, the window's size. Called where
    /// a frame begins, so that culling and drawing of one frame agree on one layout.
    void begin_frame(ClientSurface& surface);
    /// Where DrawTarget::offered_views() look, as far as they look elsewhere.
    std::vector<geom::View> views_of(const DrawTarget& target);
    /// There are some, whether they look elsewhere or with one eye.
    bool is_seen_elsewhere(const DrawTarget& target);
    /// Whether its node answers with pixels; one that records has none.
    bool may_be_read(const TargetLayer& layer);
    Wholeness wholeness(const ClientSurface& surface);
    /// Every node has all of its pixels, at the window's own resolution.
    bool everywhere(const ClientSurface& surface);
    /// Every node draws all of it from now on; it may be so.
    void draw_whole(ClientSurface& surface);
    /// Ends a frame on every node that shows the surface. `context`: the current one; 0: none.
    void swap(ContextId context, ClientSurface& surface);

    // ---- commands; the context's block has been sent before ----
    /// Sends a block of geometry to the nodes that it touches, its vertices a little off if that may be. `source.state`
    /// is that behind the block, then.
    void submit_block(const DrawSource& source, Packer& packer, const glstate::Projection& projection);
    /// Runs `pack(buffer)` inside a Block on every layer of the draw target that `drawn` touches.
    template <class Pack>
    void draw(const DrawSource& source, const Drawn& drawn, const Needs& needs, Pack&& pack);
    /// The same of a draw that names objects (named_objects.h).
    template <class Named, class Pack>
    void draw(const DrawSource& source, const Drawn& drawn, const Needs& needs, const Named& named, Pack&& pack);
    /// Runs `pack(buffer, node)` outside of blocks on every node, with nothing brought up to date.
    template <class Pack>
    void on_every_node(ContextId context, Pack&& pack);
    /// Tells every node that holds an object that it is gone.
    void delete_object(ContextId context, ClientName object);
    void destroy_context(ContextId context);
    /// Before a clear of all of these buffers (bits of glClear); `wipes`: of a window it leaves nothing from before.
    void before_clear(const DrawSource& source, std::uint32_t mask, bool wipes);
    /// Runs `use(HiddenParts&)`, before something that what is kept may matter to.
    template <class Use>
    void hidden_parts(Use&& use) {
        packing([&] { use(hidden_); });
    }

    /// The same with `use(DrawnParts&)`.
    template <class Use>
    void drawn_parts(Use&& use) {
        packing([&] { use(drawn_); });
    }
    /// Before an object that was drawn with, or to, changes or goes.
    void before_object_changes(ClientName object);

    // ---- questions; the context's block has been sent before ----
    /// Packs a command that wants an answer, `pack(buffer, request)`, behind everything that drawing with the context
    /// needs, sends it and waits. Nothing if the node is lost. `function`: for the count of round trips.
    template <class Pack>
    std::optional<std::vector<std::byte>> ask(const DrawSource& source, Node& node, const char* function, Pack&& pack);
    /// The same for several layers of the read target, `pack(buffer, request, i)`: all are asked before the first
    /// answer is waited for, so it is one round trip. An answer for each layer in order; nothing where a node is lost.
    template <class Pack>
    std::vector<std::optional<std::vector<std::byte>>> ask_all(const DrawSource& source,
                                                               const std::vector<TargetLayer>& layers,
                                                               const char* function, Pack&& pack);

    /// Everything queued goes out; `wait` also waits until all nodes have executed it. A frame of `target` ends where
    /// that is shown at once; it may be nothing.
    void flush(const DrawTarget& target, bool wait);
    /// A mark behind everything that has been packed so far, for the nodes that can be expected to answer. It goes out
    /// with the next flush.
    Fence fence();
    /// The same with a question, `pack(buffer, request)`, whose answers tell that it has been reached.
    template <class Pack>
    Fence ask_later(Pack&& pack);
    /// Waits for it, at most until the deadline or as long as a node may take for an answer. `function`: for the count
    /// of round trips. False: the time is over.
    bool wait_for(const Fence& fence, Fence::Clock::time_point deadline, const char* function);
    /// A command of GL_CR_synchronization. `note(SyncObjects&)` gives its OpenGL error, which is returned; if there is
    /// none, `pack(buffer)` says it to all nodes, behind everything before it. `at_once`: others may wait for it, or
    /// the stream is held behind it.
    template <class Note, class Pack>
    GLenum synchronize(ContextId context, bool at_once, Note&& note, Pack&& pack);
    /// glSemaphorePCR: the OpenGL error.
    GLenum take_semaphore(ContextId context, std::uint32_t name);

    std::mutex& mutex() { return mutex_; }
    /// The mutex is held.
    Nodes& nodes() { return nodes_; }

private:
    explicit ClientSession(std::unique_ptr<ControlLink> control);
    StreamEvents stream_events();
    void adopt(const Welcome& welcome, bool moved);
    void take_events();
    void leave_wall();
    void want_window_contents();
    std::vector<NodeIndex> swap_nodes(const ClientSurface& surface);
    int reply_timeout_ms() const;
    /// Runs `body` with the mutex held. Where it throws, batches and mirrors may be half made: the nodes' streams fail
    /// then, so that every node begins again at time zero.
    template <class Body>
    decltype(auto) packing(Body&& body) {
        std::lock_guard lock(mutex_);
        try {
            return std::forward<Body>(body)();
        } catch (...) {
            nodes_.distrust();
            hidden_.forget();
            throw;
        }
    }
    // Of a parallel program.
    void introduce(Node& node);
    void leave_group();

    const std::optional<Parallel>& group_ = parallel();
    const std::unique_ptr<ControlLink> control_;
    std::mutex mutex_;  // guards what follows
    SyncObjects sync_{group_ ? group_->members : 1};
    SessionId id_;
    bool moving_ = false;  ///< another wall has taken the program
    OpenSurfaces open_surfaces_;
    Nodes nodes_{stream_events()};
    std::chrono::steady_clock::duration waited_{};  ///< for nodes behind frames
    NodeUpdater updater_{nodes_};
    HiddenParts hidden_{nodes_, open_surfaces_};
    Dealer dealer_{nodes_, updater_, options().sort_last};
    WindowContents windows_{nodes_, dealer_};
    DrawnParts drawn_{nodes_, open_surfaces_};
    Surfaces surfaces_{*control_, nodes_, hidden_, open_surfaces_};
    Snapping snapping_{nodes_, options().lossy_pixels};
    Sight sight_;
    const Followers followers_{nodes_, updater_, hidden_, dealer_, windows_, drawn_, sight_};
    const std::unique_ptr<SortScratch> sort_scratch_;
};

template <class Pack>
void ClientSession::draw(const DrawSource& source, const Drawn& drawn, const Needs& needs, Pack&& pack) {
    draw(source, drawn, needs, NamesNone(), std::forward<Pack>(pack));
}

template <class Named, class Pack>
void ClientSession::draw(const DrawSource& source, const Drawn& drawn, const Needs& needs, const Named& named,
                         Pack&& pack) {
    packing([&] { draw_on(followers_, source, drawn, needs, named, pack); });
}

template <class Pack>
void ClientSession::on_every_node(ContextId context, Pack&& pack) {
    packing([&] {
        for (auto& node : nodes_)
            if (node->alive()) pack(nodes_.batch(*node, context), *node);
    });
}

template <class Note, class Pack>
GLenum ClientSession::synchronize(ContextId context, bool at_once, Note&& note, Pack&& pack) {
    return packing([&] {
        const GLenum error = note(sync_);
        if (error != GL_NO_ERROR || !group_) return error;
        for (const auto& [id, surface] : open_surfaces_) dealer_.compose(*surface);  // others may draw over it
        for (auto& node : nodes_) {
            if (!node->alive()) continue;
            pack(nodes_.batch(*node, context));
            if (at_once) nodes_.send(*node);
        }
        return error;
    });
}

template <class Pack>
Fence ClientSession::ask_later(Pack&& pack) {
    return packing([&] {
        dealer_.take_held_semaphores();
        Fence made;
        for (auto& node : nodes_) {
            if (!node->answers()) continue;
            const RequestId request = nodes_.next_request();
            pack(nodes_.batch(*node, node->batch_context), request);
            made.add(node->stream, request);
        }
        return made;
    });
}

template <class Pack>
std::optional<std::vector<std::byte>> ClientSession::ask(const DrawSource& source, Node& node, const char* function,
                                                         Pack&& pack) {
    std::shared_ptr<NodeStream> stream;  // the node may get another one meanwhile
    const RequestId request = packing([&] {
        if (!node.answers() || !source.draw) return RequestId();
        dealer_.compose(source.read);
        const RequestId next = nodes_.next_request();
        pack(updater_.prepare(node, source), next);
        stats().count_round_trip(function);
        nodes_.send(node);
        stream = node.stream;
        return next;
    });
    if (!request) return std::nullopt;
    return stream->wait_reply(request, reply_timeout_ms());
}

template <class Pack>
std::vector<std::optional<std::vector<std::byte>>> ClientSession::ask_all(const DrawSource& source,
                                                                          const std::vector<TargetLayer>& layers,
                                                                          const char* function, Pack&& pack) {
    std::vector<std::pair<std::shared_ptr<NodeStream>, RequestId>> asked;  // null: cannot be asked
    packing([&] {
        dealer_.compose(source.read);
        for (const TargetLayer& layer : layers) {
            Node& node = nodes_[layer];
            asked.emplace_back(node.answers() && source.draw ? node.stream : nullptr, nodes_.next_request());
            if (asked.back().first) pack(updater_.prepare(node, source), asked.back().second, asked.size() - 1);
        }
        for (const TargetLayer& layer : layers) nodes_.send(nodes_[layer]);
        if (!layers.empty()) stats().count_round_trip(function);
    });
    std::vector<std::optional<std::vector<std::byte>>> answers;
    for (const auto& [stream, request] : asked)
        answers.push_back(stream ? stream->wait_reply(request, reply_timeout_ms()) : std::nullopt);
    return answers;
}

}  // namespace wall::client
