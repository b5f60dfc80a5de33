// SPDX-License-Identifier: MIT
// A session's nodes: the streams to them, made all at once and made again beside the program, and what is packed for
// each. Application threads; the session's mutex is held, but where a member says otherwise.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_lib/follow/handing_on.h"
#include "client_lib/follow/kept_content.h"
#include "client_lib/follow/node.h"
#include "client_lib/geometry/target_layers.h"
#include "client_lib/link/parallel.h"
#include "client_lib/link/transport.h"
#include "client_lib/process/options.h"

namespace wall::client {

/// What is to be done when streams come and go. None may be empty.
struct StreamEvents {
    std::function<void(Node&)> opened;    ///< nothing has been packed for it yet
    std::function<void()> lost;           ///< what the node held is gone
    std::function<void()> can_be_taken;   ///< one was opened beside the program. Any thread; may outlive the nodes
    std::function<void()> stream_failed;  ///< the transport's thread; waits for nobody who waits for a stream
};

class Nodes {
public:
    explicit Nodes(StreamEvents events) : events_(std::move(events)), transport_(events_.stream_failed) {}

    auto begin() { return nodes_.begin(); }
    auto end() { return nodes_.end(); }
    std::size_t size() const { return nodes_.size(); }
    /// One that is known.
    Node& operator[](NodeIndex index) { return *nodes_[index.value]; }
    Node& operator[](const TargetLayer& layer) { return (*this)[layer.node]; }
    /// One that is known from now on.
    Node& at(NodeIndex index);

    /// A layer on each that has a stream, of whatever is drawn alike everywhere.
    const std::vector<TargetLayer>& everywhere() const { return everywhere_; }
    /// Grows whenever a node comes or goes, or has no more what it had.
    std::uint64_t changes() const { return changes_; }
    void note_change() { ++changes_; }

    // ---- streams ----
    /// As whose nodes they are spoken to.
    void set_session(SessionId session) { session_ = session; }
    /// Whether the node, as walld names it now, is the one to which there is a stream, or soon is: it keeps what it
    /// has.
    bool goes_on(const NodeInfo& info);
    /// The node, as walld names it now, is another one than before: what it held is gone.
    void connect(const NodeInfo& info);
    /// The wall is another one: nothing is left of these nodes.
    void forget_all();
    /// Of a walld that came back: nodes that it does not have any more go.
    void forget_others(const Welcome& welcome);
    /// The same as connect() for several at once, but for those that are connected to that very process; waits until
    /// something has come of each, with the lock held.
    void connect_and_wait(std::span<const NodeInfo> infos);
    /// Until what connect() has begun since the last call has come to something, at most `limit`; the lock is not held
    /// meanwhile.
    void wait_for_attempts(std::unique_lock<std::mutex>& lock, std::chrono::milliseconds limit);
    /// Opens streams again that have failed, and those of nodes that did not answer.
    void keep_connected();

    /// Nodes whose layers something touches (target_layers.h). Good until the next call.
    const NodeMasks& touched(std::span<const TargetLayer> layers, const Reach& reach) {
        nodes_touched(layers, reach, touched_);
        return touched_;
    }

    // ---- batches ----
    /// The node's batch, set to this context (earlier commands of another one are sent first).
    wire::PackBuffer& batch(Node& node, ContextId context);
    void send(Node& node);
    /// Called before a batch is sent while hold_more(true) holds.
    void before_sending(std::function<void()> call) { before_sending_ = std::move(call); }
    /// Batches are sent when there is more in them than usual: what they hold may still be changed.
    void hold_more(bool more) { holds_more_ = more; }
    // ---- parcels (common/wire/parcel.h) ----
    /// Whether there may be nodes that hand on to each other.
    bool hand_on() const { return handing_on_->open(std::chrono::steady_clock::now()); }
    /// Whether it may be one of a route.
    static bool may_hand_on(const Node& node) {
        return node.info.hands_on && node.answers() && !node.slow && node.stream->over_link();
    }
    /// Sends it to the first of them, which hands it on, behind all that was packed for any of them. At least two, all
    /// of which may.
    void hand_on(std::span<Node* const> route, ContextId context, wire::PackBuffer commands);

    /// Those that record and have asked for it have nothing any more: a file can be read from there on (T7.1). Between
    /// two frames. Whether there are such.
    bool begin_recordings_again();
    RequestId next_request() { return last_request_ = RequestId(last_request_.value + 1); }
    /// Packs a question, `pack(buffer, request)`, into the node's batch, sends it and waits for `limit_ms` with the
    /// mutex held. Counted as a round trip of `function`.
    template <class Pack>
    std::optional<std::vector<std::byte>> ask_now(Node& node, const char* function, int limit_ms, Pack&& pack) {
        const RequestId request = next_request();
        pack(node.batch, request);
        stats().count_round_trip(function);
        send(node);
        return node.stream->wait_reply(request, limit_ms);
    }
    /// What nodes drew that are not there any more (kept_content.h).
    KeptContents& kept() { return kept_; }
    /// Batches and mirrors may be half made: every node begins again at time zero.
    void distrust();

    // ---- the end; the mutex need not be held ----
    void drain(int timeout_ms) { transport_.drain(timeout_ms); }
    void give_up_all(const std::string& why) { transport_.give_up_all(why); }

private:
    void attempt(Node& node);
    void take_attempt(Node& node);
    void adopt_stream(Node& node, Result<std::shared_ptr<NodeStream>> stream);
    void keep_connected(Node& node);
    void lose(Node& node);
    NodeStream::OnParcel on_parcel(NodeIndex node) const;
    void forget(Node& node);
    void forget_content(Node& node);
    void find_everywhere();

    const std::optional<Parallel>& group_ = parallel();
    const StreamEvents events_;
    Transport transport_;
    std::vector<std::unique_ptr<Node>> nodes_;  ///< by index
    std::vector<TargetLayer> everywhere_;
    std::uint64_t changes_ = 0;
    KeptContents kept_;
    SessionId session_;
    const std::shared_ptr<HandingOn<NodeStream>> handing_on_ =
        std::make_shared<HandingOn<NodeStream>>(options().hand_on);
    bool attempts_begun_ = false;  ///< by connect(), since wait_for_attempts()
    RequestId last_request_;
    std::function<void()> before_sending_;
    bool holds_more_ = false;
    NodeMasks touched_;  ///< used again and again, so that no draw asks for memory
};

}  // namespace wall::client
