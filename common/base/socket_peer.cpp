// SPDX-License-Identifier: MIT
#include "common/base/socket_peer.h"

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <netinet/tcp.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "common/base/unique_fd.h"

namespace wall {
namespace {

/// A TCP socket's address, in the form that both the kernel's interfaces have.
struct TcpEnd {
    bool v6 = false;
    std::array<std::uint32_t, 4> address{};  ///< in network order
    std::uint16_t port = 0;                  ///< in network order
};

struct Owner {
    uid_t user = 0;
    bool listening = false;
};

TcpEnd tcp_end(const sockaddr_storage& address) {
    TcpEnd end;
    const auto* in4 = reinterpret_cast<const sockaddr_in*>(&address);
    const auto* in6 = reinterpret_cast<const sockaddr_in6*>(&address);
    end.port = in4->sin_port;  // sin6_port lies at the same place
    const bool mapped = address.ss_family == AF_INET6 && IN6_IS_ADDR_V4MAPPED(&in6->sin6_addr);
    end.v6 = address.ss_family == AF_INET6 && !mapped;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&in6->sin6_addr);
    if (end.v6) std::memcpy(end.address.data(), bytes, 16);
    else std::memcpy(end.address.data(), mapped ? static_cast<const void*>(bytes + 12) : &in4->sin_addr, 4);
    return end;
}

// ---- one socket, from SOCK_DIAG ----

struct Query {
    nlmsghdr header{};
    inet_diag_req_v2 request{};
};

Query query_for(const TcpEnd& local, const TcpEnd& remote) {
    Query query;
    query.header.nlmsg_len = sizeof query;
    query.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
    query.header.nlmsg_flags = NLM_F_REQUEST;
    query.request.sdiag_family = local.v6 ? AF_INET6 : AF_INET;
    query.request.sdiag_protocol = IPPROTO_TCP;
    query.request.idiag_states = ~0u;
    auto& id = query.request.id;
    id.idiag_sport = local.port;
    id.idiag_dport = remote.port;
    std::memcpy(id.idiag_src, local.address.data(), sizeof id.idiag_src);
    std::memcpy(id.idiag_dst, remote.address.data(), sizeof id.idiag_dst);
    id.idiag_cookie[0] = id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
    return query;
}

/// The socket with these ends, or the one that listens there. Nothing: the kernel knows none, or does not answer such
/// questions. A socket without an inode belongs to no process (any more, or yet).
std::optional<Owner> ask_kernel(const TcpEnd& local, const TcpEnd& remote) {
    const UniqueFd fd(::socket(AF_NETLINK, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_SOCK_DIAG));
    if (!fd) return std::nullopt;
    const Query query = query_for(local, remote);
    if (::send(fd.get(), &query, sizeof query, 0) != static_cast<ssize_t>(sizeof query)) return std::nullopt;
    alignas(nlmsghdr) std::array<char, 4096> answer;
    const auto bytes = ::recv(fd.get(), answer.data(), answer.size(), 0);  // it is there: the kernel answers in send()
    if (bytes < static_cast<ssize_t>(NLMSG_LENGTH(sizeof(inet_diag_msg)))) return std::nullopt;
    nlmsghdr header;
    inet_diag_msg socket;
    std::memcpy(&header, answer.data(), sizeof header);
    std::memcpy(&socket, answer.data() + NLMSG_HDRLEN, sizeof socket);
    if (header.nlmsg_type != SOCK_DIAG_BY_FAMILY || socket.idiag_inode == 0) return std::nullopt;
    const bool listening = socket.idiag_state == TCP_LISTEN;
    if (!listening && socket.id.idiag_dport != remote.port) return std::nullopt;
    return Owner{socket.idiag_uid, listening};
}

// ---- the whole table ----

/// `address:port` as /proc/net/tcp writes it: the words of the address in hexadecimal as they lie in memory.
std::string proc_text(const TcpEnd& end) {
    std::string out;
    char text[16];
    for (std::size_t i = 0; i < (end.v6 ? 4 : 1); ++i)
        out.append(text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%08X", end.address[i])));
    out.append(text, static_cast<std::size_t>(std::snprintf(text, sizeof text, ":%04X", ntohs(end.port))));
    return out;
}

std::optional<Owner> search_table(const TcpEnd& local, const TcpEnd& remote) {
    std::ifstream table(local.v6 ? "/proc/net/tcp6" : "/proc/net/tcp");
    TcpEnd anywhere;
    anywhere.v6 = local.v6;
    anywhere.port = local.port;
    const TcpEnd nobody{.v6 = local.v6};
    const std::string wanted_from = proc_text(local), wanted_to = proc_text(remote);
    const std::string listens_anywhere = proc_text(anywhere), to_nobody = proc_text(nobody);
    std::optional<Owner> listener;
    std::string line;
    while (std::getline(table, line)) {
        std::istringstream fields(line);
        std::string row, from, to, state, skipped;
        uid_t user = 0;
        std::uint64_t inode = 0;
        fields >> row >> from >> to >> state;
        const bool listens = to == to_nobody && (from == wanted_from || from == listens_anywhere);
        if (!listens && (from != wanted_from || to != wanted_to)) continue;
        for (int i = 0; i < 3; ++i) fields >> skipped;  // queues, timer, retransmits
        // A socket that its process has closed already is in the table as root's, without an inode.
        if (!(fields >> user >> skipped >> inode) || inode == 0) continue;
        if (!listens) return Owner{user, false};
        listener = Owner{user, true};
    }
    return listener;
}

std::optional<Owner> owner_of(const TcpEnd& local, const TcpEnd& remote) {
    const auto known = ask_kernel(local, remote);
    return known ? known : search_table(local, remote);
}

}  // namespace

std::optional<SocketEnds> ends_of(int fd) {
    SocketEnds ends;
    socklen_t size = sizeof ends.here;
    if (::getsockname(fd, reinterpret_cast<sockaddr*>(&ends.here), &size) != 0) return std::nullopt;
    if (ends.here.ss_family == AF_UNIX) {
        ucred credentials{};
        size = sizeof credentials;
        if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return std::nullopt;
        ends.credentials = Peer{credentials.uid, credentials.pid};
        return ends;
    }
    size = sizeof ends.there;
    if (::getpeername(fd, reinterpret_cast<sockaddr*>(&ends.there), &size) != 0) return std::nullopt;
    return ends;
}

std::optional<Peer> peer_of(const SocketEnds& ends) {
    if (ends.here.ss_family == AF_UNIX) return ends.credentials;
    const auto owner = owner_of(tcp_end(ends.there), tcp_end(ends.here));
    return owner && !owner->listening ? std::optional(Peer{owner->user, 0}) : std::nullopt;
}

std::optional<Peer> peer_of(int fd) {
    const auto ends = ends_of(fd);
    return ends ? peer_of(*ends) : std::nullopt;
}

std::optional<Peer> server_of(int fd) {
    const auto ends = ends_of(fd);
    if (!ends) return std::nullopt;
    if (ends->here.ss_family == AF_UNIX) return ends->credentials;  // of who called listen()
    const auto there = tcp_end(ends->there), here = tcp_end(ends->here);
    auto owner = ask_kernel(there, here);
    // In the listener's queue it belongs to nobody yet.
    if (!owner) owner = ask_kernel(there, TcpEnd{.v6 = there.v6});
    if (!owner) owner = search_table(there, here);
    return owner ? std::optional(Peer{owner->user, 0}) : std::nullopt;
}

}  // namespace wall
