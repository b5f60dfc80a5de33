// SPDX-License-Identifier: MIT
// What all that speaks by Asio says to it in the same way.
#pragma once

#include <netinet/in.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "common/net/address.h"

namespace wall::net {

/// An awaited operation gives its error beside its result; it does not throw.
inline constexpr auto kTuple = boost::asio::as_tuple(boost::asio::use_awaitable);

inline boost::asio::generic::stream_protocol protocol_of(const Address& address, int family) {
    return {family, address.is_unix() ? 0 : IPPROTO_TCP};
}

}  // namespace wall::net
