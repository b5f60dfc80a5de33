// SPDX-License-Identifier: MIT
#include "client_lib/follow/nodes.h"

#include <algorithm>
#include <utility>

#include "client_lib/process/log.h"
#include "common/base/quoted.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

constexpr int kConnectTimeoutMs = 2000;
constexpr std::size_t kBatchBytes =
    256 << 10;  // sent when it reaches this: large enough to be cheap, small enough to overlap

constexpr std::size_t kHeldBatchBytes = 16 << 20;  // the same of what waits for more; still one that can be coded

constexpr const char* kNotHandedOn = "another node could not hand on what it was to get";

constexpr PixelRect kEverything{-1e9f, -1e9f, 1e9f, 1e9f};

}  // namespace

Node& Nodes::at(NodeIndex index) {
    while (nodes_.size() <= index.value) {
        nodes_.push_back(std::make_unique<Node>());
        nodes_.back()->index = NodeIndex(static_cast<std::uint32_t>(nodes_.size() - 1));
    }
    return (*this)[index];
}

/// A node at time zero: whatever it needs is sent when it needs it.
void Nodes::forget(Node& node) {
    if (node.stream) {
        transport_.remove(node.stream.get());
        for (const auto& stream : handing_on_->lost(node.stream)) stream->give_up(kNotHandedOn);
    }
    node.stream.reset();
    find_everywhere();
    forget_content(node);
    node.batch.clear();
    ++node.batches;
    node.held_semaphores.clear();  // it hears of them when it is introduced again
    node.left_out.clear();
    node.slow = node.asks_unanswered = false;
    node.attempt.reset();
}

void Nodes::forget_content(Node& node) {
    note_change();
    node.mirrors.clear();
    node.object_stamps.clear();
    node.hollow.clear();
    node.brought.forget();
    node.surfaces.clear();
}

bool Nodes::begin_recordings_again() {
    bool begun = false;
    for (const auto& node : nodes_) {
        if (!node->records() || !node->alive() || !node->stream->take_begin_again()) continue;
        glapi::pack::BeginAgain(batch(*node, node->batch_context));
        send(*node);
        forget_content(*node);
        begun = true;
    }
    return begun;
}

void Nodes::find_everywhere() {
    note_change();
    everywhere_.clear();
    for (const auto& node : nodes_)
        if (node->stream) everywhere_.push_back({node->index, 0, kEverything, {}});
}

void Nodes::connect(const NodeInfo& info) {
    Node& node = at(info.node);
    node.info = info;
    forget(node);
    node.reopening = {};
    if (!node.info.up) return;
    attempt(node);
    attempts_begun_ = true;
}

bool Nodes::goes_on(const NodeInfo& info) {
    Node& node = at(info.node);
    const bool same = info.up && (node.alive() || node.attempt) && node.info.ticket == info.ticket;
    if (same) node.info = info;
    return same;
}

void Nodes::forget_others(const Welcome& welcome) {
    for (const auto& node : nodes_) {
        const bool up = std::ranges::count(welcome.nodes, node->index, &NodeInfo::node) > 0;
        const bool shows = std::ranges::count(welcome.tiles, node->index, &TileInfo::node) > 0;
        if (up || shows || !node->alive()) continue;
        connect({.node = node->index, .address = {}, .ticket = {}, .up = false});
        events_.lost();
    }
}

void Nodes::forget_all() {
    for (const auto& node : nodes_) connect({.node = node->index, .address = {}, .ticket = {}, .up = false});
    events_.lost();
}

void Nodes::connect_and_wait(std::span<const NodeInfo> infos) {
    for (const NodeInfo& info : infos) {
        if (!goes_on(info)) connect(info);
    }
    for (const NodeInfo& info : infos) {
        Node& node = at(info.node);
        if (!node.attempt) continue;
        node.attempt->wait_until(std::chrono::steady_clock::time_point::max());
        take_attempt(node);
    }
}

void Nodes::attempt(Node& node) {
    const auto hello = encode_data_hello(session_, node.info.ticket, group_ ? group_->rank : 0);
    node.attempt = ConnectAttempt::start(node.info.address, hello, kConnectTimeoutMs, events_.can_be_taken);
    if (!node.attempt) adopt_stream(node, NodeStream::open(node.info.address, hello, kConnectTimeoutMs));
}

void Nodes::wait_for_attempts(std::unique_lock<std::mutex>& lock, std::chrono::milliseconds limit) {
    if (!std::exchange(attempts_begun_, false)) return;
    std::vector<std::shared_ptr<ConnectAttempt>> attempts;
    for (const auto& node : nodes_)
        if (node->attempt) attempts.push_back(node->attempt);
    lock.unlock();
    const auto deadline = std::chrono::steady_clock::now() + limit;
    for (const auto& attempt : attempts) attempt->wait_until(deadline);
    lock.lock();
    for (const auto& node : nodes_) take_attempt(*node);
}

void Nodes::adopt_stream(Node& node, Result<std::shared_ptr<NodeStream>> stream) {
    const auto now = std::chrono::steady_clock::now();
    if (!stream) {
        log(LogLevel::warn, "event=node_refused node=%u reason=%s", node.index.value,
            in_quotes(stream.error().message).c_str());
        return node.reopening.not_opened(now);
    }
    node.reopening.opened(now);
    node.stream = std::move(*stream);
    find_everywhere();
    if (group_) node.stream->never_stalls();
    node.stream->count_for(node.index);
    node.stream->on_parcel(on_parcel(node.index));
    transport_.add(node.stream);
    events_.opened(node);
}

void Nodes::take_attempt(Node& node) {
    if (!node.attempt) return;
    auto outcome = node.attempt->take();
    if (!outcome) return;
    node.attempt.reset();
    adopt_stream(node, std::move(*outcome));
}

void Nodes::hand_on(std::span<Node* const> route, ContextId context, wire::PackBuffer commands) {
    std::vector<HandingOn<NodeStream>::Stop> stops;
    std::vector<NodeIndex> names;
    for (Node* node : route) {
        send(*node);
        stops.push_back({node->index, node->stream});
        names.push_back(node->index);
        stats().add_node(node->index, node == route.front() ? NodeCounter::batches : NodeCounter::handed_bytes,
                         node == route.front() ? 1 : commands.bytes());
    }
    const std::uint32_t number = handing_on_->begin(std::move(stops));
    for (std::size_t i = 1; i < route.size(); ++i) route[i]->stream->await_parcel(number, names[i - 1]);
    route.front()->stream->send_parcel(number, std::move(names), context, std::move(commands));
    transport_.wake();
}

/// Those that wait for what does not come begin anew, as nodes that come late. The transport's thread.
NodeStream::OnParcel Nodes::on_parcel(NodeIndex node) const {
    return [handing_on = handing_on_, node](const NodeStream::ParcelNews& news) {
        if (news.handed_on) handing_on->handed_on(*news.handed_on);
        if (!news.missed) return;
        const auto stopped = handing_on->not_handed_on(node, *news.missed, std::chrono::steady_clock::now());
        if (stopped.empty()) return;
        log(LogLevel::warn, "event=not_handed_on node=%u to=%u", node.value, news.missed->value);
        for (const auto& stream : stopped) stream->give_up(kNotHandedOn);
    };
}

// The stream has failed, whatever the node does. What it held of this process is gone with it.
void Nodes::lose(Node& node) {
    const std::string why = node.stream->failure();
    const bool ended = node.stream->ended_by_node();
    node.reopening.lost(std::chrono::steady_clock::now(), ended);
    log(LogLevel::warn, "event=stream_lost node=%u why=%s", node.index.value, in_quotes(why).c_str());
    if (node.reopening.given_up())
        complain_once("a node of the wall has ended this program's drawing again and again and is left alone: " + why,
                      "node_given_up");
    forget(node);
    events_.lost();
}

void Nodes::keep_connected() {
    for (const auto& node : nodes_) keep_connected(*node);
}

// A node that is there, but did not answer when it was asked, or whose stream has failed since. (The members of a
// parallel program take a node up together.)
void Nodes::keep_connected(Node& node) {
    if (group_) return;
    if (node.stream && node.stream->failed()) lose(node);
    take_attempt(node);
    if (!node.stream && !node.attempt && node.info.up && node.reopening.due(std::chrono::steady_clock::now()))
        attempt(node);
}

wire::PackBuffer& Nodes::batch(Node& node, ContextId context) {
    if (node.batch_context != context || node.batch.bytes() > (holds_more_ ? kHeldBatchBytes : kBatchBytes)) send(node);
    node.batch_context = context;
    return node.batch;
}

void Nodes::send(Node& node) {
    if (node.batch.empty()) return;
    if (holds_more_) before_sending_();
    if (node.alive()) {
        stats().add_node(node.index, NodeCounter::batches, 1);
        node.stream->send(node.batch_context, std::exchange(node.batch, node.stream->spare()));
        transport_.wake();
    }
    node.batch.clear();
    ++node.batches;
}

void Nodes::distrust() {
    for (auto& node : nodes_) {
        if (!node->alive()) continue;
        node->stream->give_up("out of memory");  // short enough to need none
        node->batch.clear();
        ++node->batches;
    }
}

}  // namespace wall::client
