// SPDX-License-Identifier: MIT
// Asks who is at the other end of a connection without making the wall wait: the name service and the kernel's table of
// sockets may be slow, so threads of their own ask them, and answers of the name service are kept for a while. One
// thread, but for what those threads do.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "common/base/socket_peer.h"
#include "common/daemon/changed.h"
#include "walld/control/identity.h"

namespace wall::walld {

namespace asio = boost::asio;

class WhoIsThere {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kKept{60};           ///< then a user's name and groups are asked for again
    static constexpr std::size_t kMaxKept = 1024;              ///< users
    using Lookup = std::function<Person(std::uint32_t user)>;  ///< may block; called by one other thread
    using FindPeer = std::optional<Peer> (*)(const SocketEnds& ends);  ///< the same

    WhoIsThere(const asio::any_io_executor& executor, Lookup lookup, FindPeer find_peer = peer_of)
        : lookup_(std::move(lookup)), find_peer_(find_peer), known_(executor) {}

    /// `ends`: of the connection; nothing: somebody unknown.
    asio::awaitable<Person> at(std::optional<SocketEnds> ends);
    asio::awaitable<Person> user(std::uint32_t user);
    /// Everybody is asked for again: who may do what has changed.
    void forget() { kept_.clear(); }

private:
    struct Kept {
        Person person;
        Clock::time_point until;
    };
    const Person* kept(std::uint32_t user);

    Lookup lookup_;
    FindPeer find_peer_;
    std::map<std::uint32_t, Kept> kept_;
    std::set<std::uint32_t> asked_;  ///< the name service, just now
    net::Changed known_;
    asio::thread_pool sockets_{1}, names_{1};  // last: their threads use what is above
};

}  // namespace wall::walld
