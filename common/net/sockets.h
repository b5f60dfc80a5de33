// SPDX-License-Identifier: MIT
// Listening and connected stream sockets as plain descriptors, for Asio and for blocking programs alike. Any thread.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

#include "common/base/result.h"
#include "common/base/unique_fd.h"
#include "common/net/address.h"

namespace wall::net {

/// A listening socket. A stale Unix socket file is replaced; one that somebody listens on is an error.
Result<UniqueFd> listen_on(const Address& address);
/// A connected, blocking socket.
Result<UniqueFd> connect_to(const Address& address, std::chrono::milliseconds timeout);
/// The address that a listening socket has got (port 0 resolved).
Address bound_address(int fd, const Address& asked);
/// User of the process at the other end of a Unix socket; nothing for TCP.
std::optional<uid_t> peer_user(int fd);

}  // namespace wall::net
