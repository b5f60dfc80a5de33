// SPDX-License-Identifier: MIT
#include "tools/wallagent/agent.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "common/log/refusals.h"
#include "common/wire/limits.h"
#include "tools/wallagent/user_name.h"

namespace wall::wallagent {
namespace {

asio::awaitable<std::string> look_up(uid_t user) { co_return name_of_user(user); }

proto::Envelope host_hello(uid_t user, const std::string& name) {
    proto::Envelope envelope;
    auto& hello = *envelope.mutable_host_hello();
    hello.set_version(wire::kProtocolVersion);
    hello.set_uid(user);
    hello.set_user(name);
    return envelope;
}

}  // namespace

Result<std::unique_ptr<Agent>> Agent::open(asio::any_io_executor executor, const net::Address& at,
                                           const join::Membership& joined, std::shared_ptr<const tls::TlsContext> own) {
    auto listener = net::Listener::open(executor, at);
    if (!listener) return tl::unexpected(listener.error());
    return std::unique_ptr<Agent>(new Agent(std::move(*listener), std::move(executor), joined, own));
}

Agent::Agent(net::Listener listener, asio::any_io_executor executor, const join::Membership& joined,
             const std::shared_ptr<const tls::TlsContext>& own)
    : executor_(std::move(executor)),
      listener_(std::move(listener)),
      walld_(executor_, {joined.walld, joined.walld_key}, own),
      doors_(executor_, own, listener_.address().path) {}

void Agent::start() {
    net::keep_accepting(
        executor_, listener_, [this](net::StreamSocket socket) { take(std::move(socket)); },
        [this] { return stopping_; });
}

void Agent::stop() {
    stopping_ = true;
    listener_.close();
    places_.end_all();
    doors_.close();
}

void Agent::take(net::StreamSocket socket) {
    auto program = std::make_shared<net::ControlConnection>(net::Stream(std::move(socket)));
    const auto peer = program->peer();
    if (!peer) return log::refused("agent", "somebody unknown", "nobody knows whose process it is");
    if (auto place = places_.take())
        return net::spawn(executor_, "program", serve(std::move(program), std::move(place), peer->user));
    const auto why = "this machine's agent serves " + std::to_string(kMostConnections) +
                     " connections already; try again when some have ended";
    log::refused("agent", "uid " + std::to_string(peer->user), why);
    net::spawn(executor_, "refusal", refuse_control(std::move(program), why));
}

// A program that hears `refused` before it was welcomed tries again, and at its start it tells people why; so do tools.
// Once it was welcomed the word would mean that walld has ended its session for good, and it would never come again: a
// link that is lost later is closed without one.
asio::awaitable<void> Agent::serve(Connection program, std::shared_ptr<Places::Place> place, uid_t user) {
    place->ends_with([program] { program->close(); });
    const auto name = co_await asio::co_spawn(names_, look_up(user), asio::use_awaitable);
    auto walld = co_await walld_.connect();
    if (stopping_) co_return;
    if (!walld)
        co_return co_await refuse_control(
            program, "this machine's agent cannot reach walld at " + walld.error().message +
                         " (is walld running there, and its port open? If it has another address or key now: "
                         "`wallctl join-token` there, `wallagent --join` here)");
    place->ends_with([program, link = *walld] {
        program->close();
        link->close();
    });
    (*walld)->send(host_hello(user, name));
    const auto pair = std::make_shared<const ControlPair>(ControlPair{program, *walld, std::move(place)});
    co_await relay_control(
        pair, [this](const std::string& key, const std::string& address) { return door_for(key, address); },
        [this](const std::string& why) {
            if (!stopping_) walld_.lost(why);
        });
}

std::string Agent::door_for(const std::string& key, const std::string& address) {
    const auto door = doors_.door_for(key, address);
    if (!door) log::error("door_failed node={} error={}", log::quoted(address), log::quoted(door.error().message));
    return door ? *door : "";
}

}  // namespace wall::wallagent
