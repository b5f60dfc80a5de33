// SPDX-License-Identifier: MIT
// A session's connections to its nodes: made, all at once, and made again, beside the program.
#include <utility>

#include "client_lib/follow/session.h"
#include "client_lib/process/log.h"

namespace wall::client {
namespace {

constexpr int kConnectTimeoutMs = 2000;

}  // namespace

Node& ClientSession::node_at(NodeIndex index) {
    while (nodes_.size() <= index.value) {
        nodes_.push_back(std::make_unique<Node>());
        nodes_.back()->index = NodeIndex(static_cast<std::uint32_t>(nodes_.size() - 1));
    }
    return node_of(index);
}

Node& ClientSession::node_slot(const NodeInfo& info) {
    Node& node = node_at(info.node);
    node.info = info;
    return node;
}

/// A node at time zero: whatever it needs is sent when it needs it.
void ClientSession::forget(Node& node) {
    if (node.stream) transport_.remove(node.stream.get());
    node.stream.reset();
    node.mirrors.clear();
    node.object_stamps.clear();
    node.surfaces.clear();
    node.batch.clear();
    node.left_out.clear();
    node.slow = node.asks_unanswered = false;
    node.attempt.reset();
}

// The node, as walld names it now, is another one than before.
void ClientSession::connect(Node& node) {
    forget(node);
    node.reopening = {};
    if (!node.info.up) return;
    attempt(node);
    attempts_begun_ = true;
}

void ClientSession::attempt(Node& node) {
    const auto hello = encode_data_hello(id_, node.info.ticket, group_ ? group_->rank : 0);
    const auto tell = [] {
        if (const auto session = get_if_open()) session->control_->ask_all_to_redraw();
    };
    node.attempt = ConnectAttempt::start(node.info.address, hello, kConnectTimeoutMs, tell);
    if (!node.attempt) adopt_stream(node, NodeStream::open(node.info.address, hello, kConnectTimeoutMs));
}

void ClientSession::wait_for_attempts(std::unique_lock<std::mutex>& lock, std::chrono::milliseconds limit) {
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

void ClientSession::adopt_stream(Node& node, Result<std::shared_ptr<NodeStream>> stream) {
    const auto now = std::chrono::steady_clock::now();
    if (!stream) {
        log_warning("event=node_refused node=" + std::to_string(node.index.value) + " reason=\"" +
                    stream.error().message + "\"");
        return node.reopening.not_opened(now);
    }
    node.reopening.opened(now);
    node.stream = std::move(*stream);
    if (group_) node.stream->never_stalls();
    transport_.add(node.stream);
    if (group_) introduce(node);
    place_off_wall();
}

void ClientSession::take_attempt(Node& node) {
    if (!node.attempt) return;
    auto outcome = node.attempt->take();
    if (!outcome) return;
    node.attempt.reset();
    adopt_stream(node, std::move(*outcome));
    if (node.stream && !group_) redraw();
}

// The stream has failed, whatever the node does. What it held of this process is gone with it.
void ClientSession::lose(Node& node) {
    const std::string why = node.stream->failure();
    const bool ended = node.stream->ended_by_node();
    node.reopening.lost(std::chrono::steady_clock::now(), ended);
    log_warning("event=stream_lost node=" + std::to_string(node.index.value) + " why=\"" + why + "\"");
    if (node.reopening.given_up())
        complain_once("a node of the wall has ended this program's drawing again and again and is left alone: " + why,
                      "node_given_up");
    forget(node);
    place_off_wall();
}

// A node that is there, but did not answer when it was asked, or whose stream has failed since. (The members of a
// parallel program take a node up together.)
void ClientSession::keep_connected(Node& node) {
    if (group_) return;
    if (node.stream && node.stream->failed()) lose(node);
    take_attempt(node);
    if (!node.stream && !node.attempt && node.info.up && node.reopening.due(std::chrono::steady_clock::now()))
        attempt(node);
}

}  // namespace wall::client
