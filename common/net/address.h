// SPDX-License-Identifier: MIT
// What the daemons and tools add to addresses (common/base/address.h): the ports, and where a daemon may listen. Pure.
// Any thread.
#pragma once

#include "common/base/address.h"

namespace wall::net {

using wall::Address;
using wall::kDefaultWalld;
using wall::resolve;
using wall::SocketAddress;

inline constexpr std::uint16_t kDefaultControlPort = 7770;
inline constexpr std::uint16_t kDefaultHttpPort = 7780;
inline constexpr std::uint16_t kDefaultDataPort = 7790;

/// Whom a listener lets in (docs/security.md).
enum class Peers {
    of_this_machine,  ///< the kernel says who they are
    with_keys,        ///< from anywhere, over TLS
};

/// The socket address to listen on. An error for one that other machines reach, unless their keys are asked for.
Result<SocketAddress> resolve_for_listening(const Address& address, Peers peers);

}  // namespace wall::net
