// SPDX-License-Identifier: MIT
// A session's connections to its nodes: made, made again, and tried again beside the program.
#include "client_lib/log.h"
#include "client_lib/session.h"

namespace wall::client {
namespace {

constexpr int kConnectTimeoutMs = 2000;
constexpr auto kConnectPause = std::chrono::seconds(1);  // between two attempts

}  // namespace

Node& Session::node_at(std::uint32_t index) {
    while (nodes_.size() <= index) {
        nodes_.push_back(std::make_unique<Node>());
        nodes_.back()->index = static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    return *nodes_[index];
}

Node& Session::node_slot(const NodeInfo& info) {
    Node& node = node_at(info.node);
    node.info = info;
    return node;
}

void Session::connect(Node& node) {
    if (node.stream) transport_.remove(node.stream.get());
    node.stream.reset();
    node.mirrors.clear();
    node.object_stamps.clear();
    node.surfaces.clear();
    node.batch.clear();
    node.left_out.clear();
    node.slow = node.asks_unanswered = false;
    node.attempt.reset();
    if (node.info.up)
        adopt_stream(node, NodeStream::open(node.info.address,
                                            encode_data_hello(id_, node.info.ticket, group_ ? group_->rank : 0),
                                            kConnectTimeoutMs));
}

void Session::adopt_stream(Node& node, Result<std::shared_ptr<NodeStream>> stream) {
    if (!stream) {
        log_warning("event=node_refused node=" + std::to_string(node.index) + " reason=\"" + stream.error().message +
                    "\"");
        node.next_attempt = std::chrono::steady_clock::now() + kConnectPause;
        return;
    }
    node.stream = std::move(*stream);
    if (group_) node.stream->never_stalls();
    transport_.add(node.stream);
    if (group_) introduce(node);
}

// A node that is there, but did not answer when it was asked. (The members of a parallel program take a node up
// together.)
void Session::try_again(Node& node) {
    if (node.stream || !node.info.up || group_) return;
    if (node.attempt) {
        auto outcome = node.attempt->take();
        if (!outcome) return;
        node.attempt.reset();
        adopt_stream(node, std::move(*outcome));
        if (node.stream) redraw();
    } else if (std::chrono::steady_clock::now() >= node.next_attempt) {
        node.attempt =
            ConnectAttempt::start(node.info.address, encode_data_hello(id_, node.info.ticket, 0), kConnectTimeoutMs);
    }
}

}  // namespace wall::client
