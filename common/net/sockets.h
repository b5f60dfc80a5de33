// SPDX-License-Identifier: MIT
// Listening and connected stream sockets as plain descriptors, for Asio and for blocking programs alike. Any thread.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

#include "common/base/result.h"
#include "common/base/socket_peer.h"
#include "common/base/unique_fd.h"
#include "common/net/address.h"

namespace wall::net {

/// A listening socket, which other machines cannot reach: such an address is refused. A stale Unix socket file is
/// replaced; one that somebody listens on is an error.
Result<UniqueFd> listen_on(const Address& address);
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

}  // namespace wall::net
