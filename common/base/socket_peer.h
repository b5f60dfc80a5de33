// SPDX-License-Identifier: MIT
// Whose process is at the other end of a connection, as the kernel says: the credentials of a Unix socket, the owner of
// a TCP socket of this machine. Any thread.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <optional>

namespace wall {

struct Peer {
    uid_t user = 0;
    pid_t process = 0;  ///< 0: not known
};

/// A connection's both ends as values, so that they can be looked at when the connection is closed already.
struct SocketEnds {
    sockaddr_storage here{}, there{};
    std::optional<Peer> credentials;  ///< of a Unix socket
};
/// Never waits. Nothing: it is not connected.
std::optional<SocketEnds> ends_of(int fd);

/// The process at the other end. Nothing for one that is not on this machine, in another network namespace or gone.
/// Fast where the kernel answers for one socket (SOCK_DIAG); where it does not, the whole table of TCP sockets is read.
std::optional<Peer> peer_of(const SocketEnds& ends);
std::optional<Peer> peer_of(int fd);

/// Whoever serves at the other end of a connection that we have made, also before it has accepted it: who has done so,
/// or who listens there.
std::optional<Peer> server_of(int fd);

}  // namespace wall
