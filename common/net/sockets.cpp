// SPDX-License-Identifier: MIT
#include "common/net/sockets.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "common/base/connect_within.h"

namespace wall::net {
namespace {

constexpr int kBacklog = 1024;        // all nodes and programs of a wall, which may come at once
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

/// Of TCP; empty for other sockets.
std::string host_of(const sockaddr_storage& address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    const void* bytes = nullptr;
    if (address.ss_family == AF_INET) bytes = &reinterpret_cast<const sockaddr_in&>(address).sin_addr;
    if (address.ss_family == AF_INET6) bytes = &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
    if (!bytes || !::inet_ntop(address.ss_family, bytes, text.data(), text.size())) return {};
    return text.data();
}

}  // namespace

Result<UniqueFd> listen_on(const Address& address, Peers peers) {
    auto to = resolve_for_listening(address, peers);
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

bool is_address_taken(const Error& error) { return error.message.ends_with(std::strerror(EADDRINUSE)); }

Result<UniqueFd> connect_to(const Address& address, std::chrono::milliseconds timeout) {
    auto to = resolve(address);
    if (!to) return tl::unexpected(to.error());
    auto fd = open_socket(address, *to, SOCK_NONBLOCK);
    if (!fd) return fd;
    const int error = connect_within(fd->get(), to->get(), to->length, std::chrono::steady_clock::now() + timeout);
    if (error == ETIMEDOUT) return fail(address.text() + ": cannot connect: no answer");
    if (error != 0) return system_error(address, "cannot connect", error);
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

std::string peer_text(int fd) { return peer_text(ends_of(fd)); }

std::string peer_text(const std::optional<SocketEnds>& ends) {
    const auto host = ends ? host_of(ends->there) : std::string();
    return host.empty() ? "this machine" : host;
}

std::string reachable_at(const std::string& listens, const std::optional<SocketEnds>& ends) {
    auto address = Address::parse(listens);
    if (!address || address->is_unix() || !address->any() || !ends) return listens;
    const auto host = host_of(ends->there);
    if (host.empty()) return listens;
    address->host = host;
    return address->text();
}

}  // namespace wall::net
