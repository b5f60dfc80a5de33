// SPDX-License-Identifier: MIT
// walld and the nodes of other machines, for the programs of this one: they speak to Unix sockets of this machine, and
// the agent brings that to where it belongs, over TLS, as the user whose program it is. It keeps nothing of them: when
// walld is away their connections end, and they come again by themselves. One executor, one thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <memory>

#include "common/join/membership.h"
#include "common/net/control_connection.h"
#include "common/tls/tls_context.h"
#include "tools/wallagent/control_relay.h"
#include "tools/wallagent/doors.h"
#include "tools/wallagent/places.h"
#include "tools/wallagent/walld_reach.h"

namespace wall::wallagent {

/// It must outlive its executor's handlers.
class Agent {
public:
    static constexpr std::size_t kMostConnections = 512;

    /// Listens on `at`, a Unix socket with an absolute path; `own` is what this machine proves to the others.
    static Result<std::unique_ptr<Agent>> open(asio::any_io_executor executor, const net::Address& at,
                                               const join::Membership& joined,
                                               std::shared_ptr<const tls::TlsContext> own);
    void start();
    /// Removes the sockets, and ends all connections.
    void stop();

private:
    using Connection = std::shared_ptr<net::ControlConnection>;

    Agent(net::Listener listener, asio::any_io_executor executor, const join::Membership& joined,
          const std::shared_ptr<const tls::TlsContext>& own);
    void take(net::StreamSocket socket);
    asio::awaitable<void> serve(Connection program, std::shared_ptr<Places::Place> place, uid_t user);
    std::string door_for(const std::string& key, const std::string& address);

    asio::any_io_executor executor_;
    net::Listener listener_;
    WalldReach walld_;
    Doors doors_;
    Places places_{kMostConnections};
    asio::thread_pool names_{1};  // asks the name service, which may take its time
    bool stopping_ = false;
};

}  // namespace wall::wallagent
