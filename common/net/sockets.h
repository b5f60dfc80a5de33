// SPDX-License-Identifier: MIT
// Listening and connected stream sockets as plain descriptors, for Asio and for blocking programs alike. Any thread.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/base/socket_peer.h"
#include "common/base/unique_fd.h"
#include "common/net/address.h"

namespace wall::net {

/// A listening socket; `address` is held against `peers`. A stale Unix socket file is replaced; one that somebody
/// listens on is an error.
Result<UniqueFd> listen_on(const Address& address, Peers peers = Peers::of_this_machine);
/// What listen_on() says of an address that another process has.
bool is_address_taken(const Error& error);
/// A connected, blocking socket.
Result<UniqueFd> connect_to(const Address& address, std::chrono::milliseconds timeout);
/// A daemon may open as many files as its hard limit says: each peer takes one.
void use_all_descriptors();
/// The address that a listening socket has got (port 0 resolved).
Address bound_address(int fd, const Address& asked);

using wall::Peer;
using wall::peer_of;

/// The address of the other end as people write it, without its port; "this machine" of a Unix socket.
std::string peer_text(int fd);
std::string peer_text(const std::optional<SocketEnds>& ends);
/// The address that a peer says it listens on; where that is any of its addresses (0.0.0.0, [::]), the one that it has
/// come from.
std::string reachable_at(const std::string& listens, const std::optional<SocketEnds>& ends);

}  // namespace wall::net
