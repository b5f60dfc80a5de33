// SPDX-License-Identifier: MIT
// Large content is not sent to a node that has it already from another program (A6: global share). One
// short round trip for each large object and node, when it is first drawn with there. The session's mutex is held, and
// the node's answer is waited for with it.
#pragma once

#include <cstddef>
#include <utility>

#include "client_lib/follow/session.h"
#include "common/glapi/content_hash.h"

namespace wall::client {

/// Bytes; on a network of 1 Gbit/s they take 2 ms, several times a round trip.
inline constexpr std::size_t kLeastShared = std::size_t{256} << 10;
/// The node may be waiting for another program that is sending this very content.
inline constexpr int kOfferLimitMs = 1500;

/// Whether an answer can be expected soon.
inline bool may_be_asked(const Node& node) { return node.answers() && !node.slow && !node.asks_unanswered; }

/// `pack(buffer, request)` packs the question into the node's batch. True: the node holds the content. False: send it;
/// the node then keeps it for others, too, whether its answer was that or came too late.
template <class Pack>
bool node_holds(ClientSession& session, Node& node, Pack&& pack) {
    const auto answer = session.ask_now(node, "global share", kOfferLimitMs, std::forward<Pack>(pack));
    node.asks_unanswered = !answer || answer->empty();
    return !node.asks_unanswered && answer->front() != std::byte{0};
}

}  // namespace wall::client
