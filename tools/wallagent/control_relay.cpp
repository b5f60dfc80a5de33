// SPDX-License-Identifier: MIT
#include "tools/wallagent/control_relay.h"

#include <boost/asio/steady_timer.hpp>
#include <chrono>

#include "common/daemon/keep_running.h"
#include "common/log/refusals.h"

namespace wall::wallagent {
namespace {

using Connection = std::shared_ptr<net::ControlConnection>;

constexpr std::chrono::seconds kLastBytes{2};            // for a side that does not read what is left for it
constexpr std::chrono::milliseconds kFirstMessage{200};  // programs say something at once, if at all

std::shared_ptr<asio::steady_timer> close_after(const Connection& connection, std::chrono::milliseconds time) {
    auto limit = std::make_shared<asio::steady_timer>(connection->executor(), time);
    limit->async_wait([connection, limit](const boost::system::error_code& cancelled) {
        if (!cancelled) connection->close();
    });
    return limit;
}

asio::awaitable<void> close_when_sent(Connection connection) {
    const auto limit = close_after(connection, kLastBytes);
    connection->close_after_sending();
    co_await connection->drained();
    limit->cancel();
}

/// Waits for each message to be out, so that a slow reader slows the other side down and fills no memory here.
asio::awaitable<void> pass_on(Connection to, proto::Envelope message) {
    to->send(message);
    co_await to->drained();
}

/// What both ways know.
struct Relay {
    std::shared_ptr<const ControlPair> pair;
    bool drawing = false;  ///< it has said that it is a program that draws
    bool cut = false;      ///< walld acknowledged nothing any more, and we have given that link up
};

asio::awaitable<void> to_walld(std::shared_ptr<Relay> relay) {
    const auto& pair = relay->pair;
    bool gone = false;
    while (!gone) {
        auto message = co_await pair->program->receive();
        gone = !message && pair->program->lost();
        if (!message) break;
        if (!programs_may_say(*message)) {
            log::refused("agent", "this machine", "a program speaks as a machine");
            pair->program->close();
            gone = true;
        } else {
            relay->drawing = relay->drawing || message->has_client_hello();
            co_await pass_on(pair->walld, std::move(*message));
        }
    }
    if (relay->drawing && gone) {
        proto::Envelope ended;
        ended.mutable_program_ended();
        pair->walld->send(ended);
    }
    co_await close_when_sent(pair->walld);
}

/// A program that draws is back over another link before TCP asks again on one that was cut, as its pauses double. What
/// people have asked for is not asked twice: that waits. False: there is nothing left to look at.
bool still_moves(const std::weak_ptr<Relay>& weak) {
    const auto relay = weak.lock();
    if (!relay || !relay->pair->walld->is_open()) return false;
    if (!relay->drawing || !relay->pair->walld->is_stuck()) return true;
    relay->cut = true;
    relay->pair->walld->close();
    return false;
}

}  // namespace

asio::awaitable<void> relay_control(std::shared_ptr<const ControlPair> pair, DoorFor door_for,
                                    std::function<void(const std::string& why)> lost) {
    const auto relay = std::make_shared<Relay>(pair);
    const auto executor = pair->program->executor();
    net::spawn(executor, "program to walld", to_walld(relay));
    net::look_again(executor, "watch", net::Stream::kLookForStuck,
                    [weak = std::weak_ptr(relay)] { return still_moves(weak); });
    for (;;) {
        auto message = co_await pair->walld->receive();
        if (message) {
            lead_through_doors(*message, door_for);
            co_await pass_on(pair->program, std::move(*message));
            continue;
        }
        if (relay->cut) lost("it acknowledges nothing");
        else if (message.error().message != "closed") lost(message.error().message);
        co_return co_await close_when_sent(pair->program);
    }
}

// A Unix socket that is closed before its peer has written breaks the peer's write, and nobody reads the reason then.
asio::awaitable<void> refuse_control(std::shared_ptr<net::ControlConnection> program, std::string why) {
    proto::Envelope refusal;
    refusal.mutable_refused()->set_reason(why);
    program->send(refusal);
    const auto limit = close_after(program, kFirstMessage);
    const auto hello = co_await program->receive();
    limit->cancel();
    if (hello) co_await close_when_sent(program);
}

}  // namespace wall::wallagent
