// SPDX-License-Identifier: MIT
#include "tools/wallagent/walld_reach.h"

#include <utility>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"

namespace wall::wallagent {

asio::awaitable<Result<WalldReach::Connection>> WalldReach::connect() {
    using Clock = net::Changed::Clock;
    const auto until = Clock::now() + (away_ ? kAwayPatience : kPatience);
    for (;;) {
        auto attempt = away_ ? latest_.lock() : nullptr;
        if (!attempt || attempt->over) attempt = begin();
        while (!attempt->over && Clock::now() < until) co_await attempt->ended.wait(until);
        if (!attempt->over) {
            const auto why = walld_.address.text() + ": no answer yet";
            note_away(why);
            co_return fail(why);
        }
        if (!attempt->result) co_return tl::unexpected(attempt->result.error());
        if (auto connection = std::exchange(*attempt->result, nullptr)) co_return connection;
    }
}

std::shared_ptr<WalldReach::Attempt> WalldReach::begin() {
    auto attempt = std::make_shared<Attempt>(executor_);
    latest_ = attempt;
    net::spawn(executor_, "connect to walld", run(attempt));
    return attempt;
}

asio::awaitable<void> WalldReach::run(std::shared_ptr<Attempt> attempt) {
    attempt->result = co_await net::ControlConnection::connect_tls(walld_.address, own_, walld_.key);
    attempt->over = true;
    if (attempt->result) note_there();
    else note_away(attempt->result.error().message);
    attempt->ended.notify();
}

void WalldReach::note_away(const std::string& why) {
    if (!std::exchange(away_, true)) log::warn("walld_away error={}", log::quoted(why));
}

void WalldReach::note_there() {
    if (std::exchange(away_, false)) log::info("walld_there address={}", log::quoted(walld_.address.text()));
}

}  // namespace wall::wallagent
