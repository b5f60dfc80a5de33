// SPDX-License-Identifier: MIT
// The ways of partial pictures to other nodes: a connection for each session and node, made when there is something to
// send, to the data port of that node, with the session's ticket there. What cannot be sent is dropped: who waits for
// it goes on without. I/O thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/ids.h"
#include "common/net/address.h"
#include "common/tls/fingerprint.h"
#include "common/tls/tls_context.h"

namespace wall::tileserver {

namespace asio = boost::asio;

/// Another node of a session, as walld names it.
struct PartialPeer {
    net::Address address;
    std::string ticket;
    std::optional<tls::Fingerprint> key;  ///< none: it is on this machine
    bool operator==(const PartialPeer&) const = default;
};

class PartialLinks {
public:
    /// What may wait for one node before the newest are dropped.
    static constexpr std::size_t kMostQueued = std::size_t{256} << 20;  // bytes

    /// `tls`: the own key, for nodes of other machines; null: they cannot be reached.
    PartialLinks(asio::any_io_executor executor, std::shared_ptr<const tls::TlsContext> tls);
    /// Of what goes to other machines from now on; a check_partial_codec().
    void set_codec(std::string name) { codec_ = std::move(name); }
    ~PartialLinks();

    /// Links to nodes that are not there any more, or are others now, go.
    void set_peers(SessionId session, std::map<NodeIndex, PartialPeer> peers);
    void forget(SessionId session);
    void send(SessionId session, NodeIndex to, std::vector<std::byte> message);
    void close();

private:
    class Link;
    using Key = std::pair<SessionId, NodeIndex>;

    asio::any_io_executor executor_;
    std::shared_ptr<const tls::TlsContext> tls_;
    std::string codec_ = "lz4";
    std::map<Key, PartialPeer> peers_;
    std::map<Key, std::shared_ptr<Link>> links_;
};

}  // namespace wall::tileserver
