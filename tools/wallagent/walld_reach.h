// SPDX-License-Identifier: MIT
// Connections to the walld of another machine, and whether that can be reached at all. One executor, one thread.
//
// Whoever connects to us is kept waiting no longer than they would wait for an answer themselves: an attempt that takes
// longer goes on without them, and says only whether walld is there. While it is not, there is one attempt at a time,
// and people are told within kAwayPatience: a parallel program that has lost walld takes a connection that stays open
// for 500 ms (kLifeSign, client_lib/link/control.cpp) for a new walld, and ends.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "common/daemon/changed.h"
#include "common/net/control_connection.h"

namespace wall::wallagent {

namespace asio = boost::asio;

/// It must outlive its executor's handlers.
class WalldReach {
public:
    using Connection = std::shared_ptr<net::ControlConnection>;

    static constexpr std::chrono::milliseconds kPatience{2000}, kAwayPatience{300};

    struct Walld {
        net::Address address;
        tls::Fingerprint key;
    };
    WalldReach(asio::any_io_executor executor, Walld walld, std::shared_ptr<const tls::TlsContext> own)
        : executor_(std::move(executor)), walld_(std::move(walld)), own_(std::move(own)) {}

    /// Nobody else has it. The error names the address.
    asio::awaitable<Result<Connection>> connect();
    /// A connection has broken.
    void lost(const std::string& why) { note_away(why); }

private:
    struct Attempt {
        explicit Attempt(const asio::any_io_executor& executor) : ended(executor) {}
        net::Changed ended;
        bool over = false;
        Result<Connection> result = fail("");  ///< null: somebody has taken it
    };
    std::shared_ptr<Attempt> begin();
    asio::awaitable<void> run(std::shared_ptr<Attempt> attempt);
    void note_away(const std::string& why);
    void note_there();

    asio::any_io_executor executor_;
    Walld walld_;
    std::shared_ptr<const tls::TlsContext> own_;
    bool away_ = false;
    std::weak_ptr<Attempt> latest_;
};

}  // namespace wall::wallagent
