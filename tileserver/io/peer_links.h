// SPDX-License-Identifier: MIT
// The ways to a session's other nodes: of partial pictures, and of parcels that are handed on. A connection each for
// every session and node, made when there is something to send, to the data port of that node, with the session's
// ticket there. What cannot be sent is dropped: who waits for a partial picture goes on without, and the program hears
// of a parcel. I/O thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "common/base/ids.h"
#include "common/base/raw_bytes.h"
#include "common/net/address.h"
#include "common/tls/fingerprint.h"
#include "common/tls/tls_context.h"

namespace wall::tileserver {

namespace asio = boost::asio;

/// Another node of a session, as walld names it.
struct Peer {
    net::Address address;
    std::string ticket;
    std::optional<tls::Fingerprint> key;  ///< none: it is on this machine
    bool operator==(const Peer&) const = default;
};

class PeerLinks {
public:
    /// What may wait for one node before the newest partial pictures are dropped.
    static constexpr std::size_t kMostQueued = std::size_t{256} << 20;  // bytes
    /// Pieces of parcels that may wait for one node; more are not taken from who sends them.
    static constexpr std::size_t kMostPieces = std::size_t{4} << 20;  // bytes

    /// What was to be handed on to that node may not have come there.
    using NotHandedOn = std::function<void(SessionId session, NodeIndex to)>;

    /// `tls`: the own key, for nodes of other machines; null: they cannot be reached.
    PeerLinks(asio::any_io_executor executor, std::shared_ptr<const tls::TlsContext> tls, NotHandedOn not_handed_on);
    /// Of partial pictures that go to other machines from now on; a check_partial_codec().
    void set_codec(std::string name) { codec_ = std::move(name); }
    ~PeerLinks();

    /// Links to nodes that are not there any more, or are others now, go.
    void set_peers(SessionId session, std::map<NodeIndex, Peer> peers);
    void forget(SessionId session);
    void send_partial(SessionId session, NodeIndex to, std::vector<std::byte> message);
    /// A piece of a parcel. Waits until there is room for it, and at first for walld to tell where that node is.
    asio::awaitable<void> hand_on(SessionId session, NodeIndex to, std::uint32_t number, RawBytes piece);
    void close();
    /// Ends those links over which nothing comes any more (net::Stream::is_stuck()), so that others need not wait for
    /// TCP to see it. Every net::Stream::kLookForStuck or so.
    void end_stuck();

    /// Of parcels, to all nodes.
    std::uint64_t bytes_handed_on() const { return bytes_handed_on_; }

private:
    class Link;
    enum class Brings { partials, parcels };
    using Key = std::tuple<SessionId, NodeIndex, Brings>;

    /// Null: the node is not known.
    std::shared_ptr<Link> link(SessionId session, NodeIndex to, Brings brings);
    void tell(SessionId session, NodeIndex to);

    asio::any_io_executor executor_;
    std::shared_ptr<const tls::TlsContext> tls_;
    NotHandedOn not_handed_on_;
    std::string codec_ = "lz4";
    std::map<std::pair<SessionId, NodeIndex>, Peer> peers_;
    std::map<Key, std::shared_ptr<Link>> links_;
    std::map<std::pair<SessionId, NodeIndex>, std::uint32_t> unknown_;  // not among peers_; the last parcel for them
    std::uint64_t bytes_handed_on_ = 0;
    bool closed_ = false;
};

}  // namespace wall::tileserver
