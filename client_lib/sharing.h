// SPDX-License-Identifier: MIT
// Large content is not sent to a node that has it already from another program (AnyGL, section 6: global share). One short
// round trip for each large object and node, when it is first drawn with there. The session's mutex is held, and the node's
// answer is waited for with it.
#pragma once

#include <cstddef>
#include <span>

#include "client_lib/session.h"
#include "common/glapi/content_hash.h"

namespace wall::client {

/// Bytes; on a network of 1 Gbit/s they take 2 ms, several times a round trip.
inline constexpr std::size_t kLeastShared = std::size_t{256} << 10;
/// The node may be waiting for another program that is sending this very content.
inline constexpr int kOfferLimitMs = 1500;

enum class Offer {
    not_made,  ///< the node does not answer: send the content
    wanted,    ///< send it; the node then keeps it for others, too
    held,      ///< nothing to do
};

/// `pack(request, key)` packs the question into the node's batch.
template <class Pack>
Offer offer_content(Session& session, Node& node, const glapi::ContentKey& key, Pack&& pack) {
    if (!node.answers() || node.slow || node.asks_unanswered) return Offer::not_made;
    const auto answer = session.ask_now(node, "global share", kOfferLimitMs, [&](wire::PackBuffer&, std::uint32_t request) { pack(request, key); });
    if (!answer || answer->empty()) {
        node.asks_unanswered = true;
        return Offer::not_made;
    }
    return answer->front() == std::byte{0} ? Offer::wanted : Offer::held;
}

}  // namespace wall::client
