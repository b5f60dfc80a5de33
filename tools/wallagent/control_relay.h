// SPDX-License-Identifier: MIT
// Passes one program's control messages on, both ways. One executor, one thread.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/net/control_connection.h"
#include "tools/wallagent/envelopes.h"
#include "tools/wallagent/places.h"

namespace wall::wallagent {

namespace asio = boost::asio;

struct ControlPair {
    std::shared_ptr<net::ControlConnection> program, walld;
    std::shared_ptr<Places::Place> place;  ///< taken as long as one of the two is served
};

/// Until either side ends; what has come from it is sent on, then the other one is closed. `lost` is told why walld's
/// side has ended before the program can know of it; nothing if that was in order, or by us.
asio::awaitable<void> relay_control(std::shared_ptr<const ControlPair> pair, DoorFor door_for,
                                    std::function<void(const std::string& why)> lost);

/// Says `why` in such a way that whoever has just connected reads it, and closes.
asio::awaitable<void> refuse_control(std::shared_ptr<net::ControlConnection> program, std::string why);

}  // namespace wall::wallagent
