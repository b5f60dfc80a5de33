// SPDX-License-Identifier: MIT
#include "common/net/sockets.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace wall::net {
namespace {

constexpr int kBacklog = 64;
constexpr mode_t kSocketMode = 0666;  // who may speak is decided by peer_of(), which can say why

tl::unexpected<Error> system_error(const Address& address, const char* what, int error) {
    return fail(address.text() + ": " + what + ": " + std::strerror(error));
}

Result<UniqueFd> open_socket(const Address& address, const SocketAddress& to, int flags) {
    UniqueFd fd(::socket(to.family(), SOCK_STREAM | SOCK_CLOEXEC | flags, 0));
    if (!fd) return system_error(address, "socket", errno);
    const int on = 1;
    if (!address.is_unix()) ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
}

/// A socket file without a listener is what a killed daemon leaves behind.
void remove_stale(const Address& address, const SocketAddress& to) {
    struct stat info {};
    if (::lstat(address.path.c_str(), &info) != 0 || !S_ISSOCK(info.st_mode)) return;
    UniqueFd probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (::connect(probe.get(), to.get(), to.length) != 0 && errno == ECONNREFUSED) ::unlink(address.path.c_str());
}

/// `address:port` as /proc/net/tcp writes it: the words of the address in hexadecimal as they lie in memory.
std::string proc_text(const sockaddr_storage& address) {
    const bool v6 = address.ss_family == AF_INET6;
    const auto* in4 = reinterpret_cast<const sockaddr_in*>(&address);
    const auto* in6 = reinterpret_cast<const sockaddr_in6*>(&address);
    std::array<std::uint32_t, 4> words{};
    std::memcpy(words.data(), v6 ? static_cast<const void*>(&in6->sin6_addr) : &in4->sin_addr, v6 ? 16 : 4);
    std::string out;
    char text[16];
    for (int i = 0; i < (v6 ? 4 : 1); ++i)
        out.append(text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%08X", words[i])));
    out.append(text, static_cast<std::size_t>(std::snprintf(text, sizeof text, ":%04X", ntohs(in4->sin_port))));
    return out;
}

/// The kernel's table of TCP sockets names each one's owner; the peer's own socket is in it if it is on this machine.
std::optional<Peer> owner_of_tcp_peer(int fd) {
    sockaddr_storage here{}, there{};
    socklen_t size = sizeof here;
    if (::getsockname(fd, reinterpret_cast<sockaddr*>(&here), &size) != 0) return std::nullopt;
    size = sizeof there;
    if (::getpeername(fd, reinterpret_cast<sockaddr*>(&there), &size) != 0) return std::nullopt;
    std::ifstream table(there.ss_family == AF_INET6 ? "/proc/net/tcp6" : "/proc/net/tcp");
    const std::string local = proc_text(there), remote = proc_text(here);
    std::string line;
    while (std::getline(table, line)) {
        std::istringstream fields(line);
        std::string row, from, to, skipped;
        uid_t user = 0;
        std::uint64_t inode = 0;
        fields >> row >> from >> to;
        if (from != local || to != remote) continue;
        for (int i = 0; i < 4; ++i) fields >> skipped;  // st, queues, timer, retransmits
        // A socket that its process has closed already is in the table as root's, without an inode.
        if (fields >> user >> skipped >> inode && inode != 0) return Peer{user, 0};
    }
    return std::nullopt;
}

}  // namespace

Result<UniqueFd> listen_on(const Address& address) {
    auto to = resolve_for_listening(address);
    if (!to) return tl::unexpected(to.error());
    auto fd = open_socket(address, *to, SOCK_NONBLOCK);
    if (!fd) return fd;
    const int on = 1;
    if (address.is_unix()) remove_stale(address, *to);
    else ::setsockopt(fd->get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (::bind(fd->get(), to->get(), to->length) != 0) return system_error(address, "cannot listen", errno);
    if (address.is_unix()) ::chmod(address.path.c_str(), kSocketMode);
    if (::listen(fd->get(), kBacklog) != 0) return system_error(address, "cannot listen", errno);
    return fd;
}

Result<UniqueFd> connect_to(const Address& address, std::chrono::milliseconds timeout) {
    auto to = resolve(address);
    if (!to) return tl::unexpected(to.error());
    auto fd = open_socket(address, *to, SOCK_NONBLOCK);
    if (!fd) return fd;
    if (::connect(fd->get(), to->get(), to->length) != 0) {
        if (errno != EINPROGRESS) return system_error(address, "cannot connect", errno);
        pollfd wait{fd->get(), POLLOUT, 0};
        if (::poll(&wait, 1, static_cast<int>(timeout.count())) <= 0)
            return fail(address.text() + ": cannot connect: no answer");
        int error = 0;
        socklen_t size = sizeof error;
        ::getsockopt(fd->get(), SOL_SOCKET, SO_ERROR, &error, &size);
        if (error != 0) return system_error(address, "cannot connect", error);
    }
    ::fcntl(fd->get(), F_SETFL, ::fcntl(fd->get(), F_GETFL) & ~O_NONBLOCK);
    return fd;
}

void use_all_descriptors() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

Address bound_address(int fd, const Address& asked) {
    if (asked.is_unix()) return asked;
    SocketAddress got;
    got.length = sizeof got.storage;
    ::getsockname(fd, reinterpret_cast<sockaddr*>(&got.storage), &got.length);
    Address out = asked;
    // sin_port and sin6_port lie at the same place.
    out.port = ntohs(reinterpret_cast<const sockaddr_in*>(&got.storage)->sin_port);
    return out;
}

std::optional<Peer> peer_of(int fd) {
    sockaddr_storage name{};
    socklen_t size = sizeof name;
    if (::getsockname(fd, reinterpret_cast<sockaddr*>(&name), &size) != 0) return std::nullopt;
    if (name.ss_family != AF_UNIX) return owner_of_tcp_peer(fd);
    ucred credentials{};
    size = sizeof credentials;
    if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return std::nullopt;
    return Peer{credentials.uid, credentials.pid};
}

}  // namespace wall::net
