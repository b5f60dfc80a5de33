// SPDX-License-Identifier: MIT
#include "client_lib/link/stream_attempts.h"

#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "client_lib/link/control_messages.h"
#include "client_lib/link/node_greeting.h"
#include "client_lib/process/process.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kOneAttempt = std::chrono::seconds(2);  // an agent asks the node several times in it
constexpr auto kBetweenAttempts = std::chrono::milliseconds(50);
constexpr auto kAttempts = std::chrono::seconds(10);  // all of them

}  // namespace

std::shared_ptr<StreamAttempts> StreamAttempts::start(Wanted wanted) {
    auto attempts = std::make_shared<StreamAttempts>();
    const SignalsBlocked blocked;
    try {
        std::thread([attempts, wanted = std::move(wanted)] { attempts->run(wanted); }).detach();
    } catch (const std::system_error&) {
        return nullptr;
    }
    return attempts;
}

void StreamAttempts::run(const Wanted& wanted) {
    const auto end = Clock::now() + kAttempts;
    for (;;) {
        bool refused = false;
        auto connection = once(wanted, refused);
        const bool last = connection || refused || Clock::now() >= end;
        {
            const std::lock_guard lock(mutex_);
            if (last) outcome_ = std::move(connection);
            if (last || stop_) return;
        }
        std::this_thread::sleep_for(kBetweenAttempts);
    }
}

Result<StreamAttempts::Connection> StreamAttempts::once(const Wanted& wanted, bool& refused) {
    const std::string& address = wanted.address;
    const auto begin = Clock::now(), deadline = begin + kOneAttempt;
    const auto number = std::chrono::duration_cast<std::chrono::microseconds>(begin.time_since_epoch()).count();
    const auto hello = wanted.hello + encode_resume(wanted.stream, wanted.received, static_cast<std::uint64_t>(number));
    auto greeting = greet_node(address, hello, -1, deadline);
    if (!greeting) return tl::unexpected(greeting.error());
    const Answer& answer = greeting->answer;
    refused = answer.refuses();
    if (!answer.why.empty()) return fail(answer.why);
    if (answer.kind != wire::FrameKind::resumed) return fail(address + " does not speak this protocol");
    return Connection{std::move(greeting->fd), answer.number};
}

std::optional<Result<StreamAttempts::Connection>> StreamAttempts::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(outcome_, std::nullopt);
}

void StreamAttempts::stop() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
}

}  // namespace wall::client
