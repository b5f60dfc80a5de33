// SPDX-License-Identifier: MIT
// Where something listens, as people write it: `unix:PATH` or `HOST:PORT` (an IPv6 host in brackets). The daemons, the
// tools and the client library read addresses with this alone. Pure, but for resolve(), which may ask the name service.
// Any thread.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace wall {

struct Address {
    std::string path;        ///< of a Unix socket; empty: TCP
    std::string host;        ///< TCP
    std::uint16_t port = 0;  ///< TCP; 0 when listening: the kernel chooses

    static Result<Address> parse(std::string_view text);

    bool is_unix() const { return !path.empty(); }
    /// True for what only this machine can reach: a Unix socket, `localhost`, 127.0.0.0/8, ::1.
    bool local() const;
    /// True for what means every address of a machine: 0.0.0.0, [::].
    bool any() const { return host == "0.0.0.0" || host == "::"; }
    std::string text() const;
    bool operator==(const Address&) const = default;
};

/// Where walld is when nobody says otherwise (WALLGL_WALLD, --walld).
inline constexpr const char* kDefaultWalld = "unix:/run/wallgl/walld.sock";

/// What the socket calls want.
struct SocketAddress {
    sockaddr_storage storage{};
    socklen_t length = 0;

    int family() const { return storage.ss_family; }
    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
    /// True for a Unix socket and for loopback addresses.
    bool local() const;
};
Result<SocketAddress> resolve(const Address& address);

}  // namespace wall
