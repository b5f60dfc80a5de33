// SPDX-License-Identifier: MIT
#include "common/base/address.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <sys/un.h>

#include <charconv>
#include <cstddef>
#include <cstring>
#include <memory>

namespace wall {
namespace {

constexpr std::string_view kUnixPrefix = "unix:";
constexpr std::uint32_t kLoopbackNet = 127;  // the first byte of IPv4's loopback addresses

Result<Address> bad(std::string_view text) {
    return fail("address '" + std::string(text) + "': expected unix:PATH or HOST:PORT");
}

bool loopback(const in_addr& v4) { return (ntohl(v4.s_addr) >> 24) == kLoopbackNet; }

Result<SocketAddress> resolve_unix(const std::string& path) {
    SocketAddress out;
    auto* address = reinterpret_cast<sockaddr_un*>(&out.storage);
    if (path.size() >= sizeof address->sun_path) {
        return fail("unix:" + path + ": a socket's path may have at most " +
                    std::to_string(sizeof address->sun_path - 1) + " bytes");
    }
    address->sun_family = AF_UNIX;
    std::memcpy(address->sun_path, path.c_str(), path.size() + 1);
    out.length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size() + 1);
    return out;
}

}  // namespace

Result<Address> Address::parse(std::string_view text) {
    Address out;
    if (text.starts_with(kUnixPrefix)) {
        out.path = text.substr(kUnixPrefix.size());
        return out.path.empty() ? bad(text) : Result<Address>(out);
    }
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos || colon == 0) return bad(text);
    auto host = text.substr(0, colon);
    const auto port = text.substr(colon + 1);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    else if (host.find_first_of(":[]/") != std::string_view::npos) return bad(text);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), out.port);
    if (host.empty() || error != std::errc{} || end != port.data() + port.size()) return bad(text);
    out.host = host;
    return out;
}

bool Address::local() const {
    if (is_unix() || host == "localhost") return true;
    in_addr v4{};
    in6_addr v6{};
    if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return loopback(v4);
    return inet_pton(AF_INET6, host.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

std::string Address::text() const {
    if (is_unix()) return std::string(kUnixPrefix) + path;
    const bool v6 = host.find(':') != std::string::npos;
    return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

bool SocketAddress::local() const {
    switch (family()) {
        case AF_UNIX: return true;
        case AF_INET: return loopback(reinterpret_cast<const sockaddr_in*>(&storage)->sin_addr);
        case AF_INET6: return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6*>(&storage)->sin6_addr);
        default: return false;
    }
}

Result<SocketAddress> resolve(const Address& address) {
    if (address.is_unix()) return resolve_unix(address.path);
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_NUMERICSERV;
    addrinfo* found = nullptr;
    const int error = getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
    if (error != 0) return fail(address.text() + ": " + gai_strerror(error));
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
    SocketAddress out;
    std::memcpy(&out.storage, found->ai_addr, found->ai_addrlen);
    out.length = found->ai_addrlen;
    return out;
}

}  // namespace wall
