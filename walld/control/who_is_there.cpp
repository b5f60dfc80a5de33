// SPDX-License-Identifier: MIT
#include "walld/control/who_is_there.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>

namespace wall::walld {
namespace {

asio::awaitable<std::optional<Peer>> look_for_peer(WhoIsThere::FindPeer find_peer, SocketEnds ends) {
    co_return find_peer(ends);
}

/// Nothing: it cannot be found out now.
asio::awaitable<std::optional<Person>> look_up(const WhoIsThere::Lookup& lookup, std::uint32_t user) {
    try {
        co_return lookup(user);
    } catch (const std::exception&) {
        co_return std::nullopt;
    }
}

}  // namespace

asio::awaitable<Person> WhoIsThere::at(std::optional<SocketEnds> ends) {
    if (!ends) co_return Person{};
    auto peer = ends->credentials;
    if (!peer) peer = co_await asio::co_spawn(sockets_, look_for_peer(find_peer_, *ends), asio::use_awaitable);
    if (!peer) co_return Person{};
    co_return co_await user(peer->user);
}

const Person* WhoIsThere::kept(std::uint32_t user) {
    const auto found = kept_.find(user);
    return found != kept_.end() && Clock::now() < found->second.until ? &found->second.person : nullptr;
}

/// Many connections of a user are one question.
asio::awaitable<Person> WhoIsThere::user(std::uint32_t user) {
    for (;;) {
        if (const auto* known = kept(user)) co_return *known;
        if (!asked_.contains(user)) break;
        co_await known_.wait(Clock::now() + kKept);
    }
    asked_.insert(user);
    const auto person = co_await asio::co_spawn(names_, look_up(lookup_, user), asio::use_awaitable);
    asked_.erase(user);
    known_.notify();
    if (!person) co_return Person{Person::Kind::unix_user, "uid " + std::to_string(user), user, Role::none};
    if (kept_.size() >= kMaxKept) kept_.clear();
    kept_[user] = {*person, Clock::now() + kKept};
    co_return *person;
}

}  // namespace wall::walld
