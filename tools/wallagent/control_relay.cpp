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

asio::awaitable<void> to_walld(std::shared_ptr<const ControlPair> pair) {
    bool drawing = false, gone = false;  // it has said that it is a program that draws
    while (!gone) {
        auto message = co_await pair->program->receive();
        gone = !message && pair->program->lost();
        if (!message) break;
        if (!programs_may_say(*message)) {
            log::refused("agent", "this machine", "a program speaks as a machine");
            pair->program->close();
            gone = true;
        } else {
            drawing = drawing || message->has_client_hello();
            co_await pass_on(pair->walld, std::move(*message));
        }
    }
    if (drawing && gone) {
        proto::Envelope ended;
        ended.mutable_program_ended();
        pair->walld->send(ended);
    }
    co_await close_when_sent(pair->walld);
}

}  // namespace

asio::awaitable<Error> relay_control(std::shared_ptr<const ControlPair> pair, DoorFor door_for) {
    net::spawn(pair->program->executor(), "program to walld", to_walld(pair));
    for (;;) {
        auto message = co_await pair->walld->receive();
        if (!message) {
            co_await close_when_sent(pair->program);
            co_return message.error();
        }
        lead_through_doors(*message, door_for);
        co_await pass_on(pair->program, std::move(*message));
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
