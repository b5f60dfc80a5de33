// SPDX-License-Identifier: MIT
// Brings bytes from one stream to another, and back: a program's commands to a node, and its answers. Nobody reads
// faster than the other end writes. One executor, one thread.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <memory>

#include "common/net/stream.h"
#include "tools/wallagent/places.h"

namespace wall::wallagent {

namespace asio = boost::asio;

/// Until either end closes; the other one is closed when it has got everything. `place` is taken up to then.
asio::awaitable<void> relay_bytes(net::Stream one, net::Stream other, std::shared_ptr<Places::Place> place);

}  // namespace wall::wallagent
