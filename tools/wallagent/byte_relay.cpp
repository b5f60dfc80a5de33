// SPDX-License-Identifier: MIT
#include "tools/wallagent/byte_relay.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"

namespace wall::wallagent {
namespace {

constexpr std::size_t kRoom = std::size_t{256} << 10;  // bytes, each way
constexpr auto kWatch = std::chrono::milliseconds(250);

struct Pair {
    net::Stream one, other;
    std::shared_ptr<Places::Place> place;
};

/// `pair` keeps both streams.
asio::awaitable<void> pump([[maybe_unused]] std::shared_ptr<Pair> pair, net::Stream& from, net::Stream& to) {
    const auto room = std::make_unique_for_overwrite<std::byte[]>(kRoom);
    for (;;) {
        const auto [ended, bytes] = co_await from.read_some(asio::buffer(room.get(), kRoom));
        if (ended) break;
        const auto [broken, written] = co_await to.write(asio::buffer(room.get(), bytes));
        if (broken) co_return;  // its last words, such as why it goes, are read on the way back, which closes `from`
    }
    to.close();
}

/// A link that is cut is given up: the program comes to the node over another connection, as soon as there is a link.
asio::awaitable<void> watch(std::weak_ptr<Pair> weak) {
    asio::steady_timer timer(co_await asio::this_coro::executor);
    for (;;) {
        timer.expires_after(kWatch);
        co_await timer.async_wait(asio::as_tuple(asio::use_awaitable));
        const auto pair = weak.lock();
        if (!pair || !pair->other.is_open()) co_return;
        if (!pair->other.is_stuck()) continue;
        log::warn("node_stuck node={}", log::quoted(net::peer_text(pair->other.descriptor())));
        pair->one.close();
        pair->other.close();
        co_return;
    }
}

}  // namespace

asio::awaitable<void> relay_bytes(net::Stream one, net::Stream other, std::shared_ptr<Places::Place> place) {
    const auto pair = std::make_shared<Pair>(Pair{std::move(one), std::move(other), std::move(place)});
    pair->place->ends_with([weak = std::weak_ptr(pair)] {
        const auto open = weak.lock();
        if (!open) return;
        open->one.close();
        open->other.close();
    });
    net::spawn(pair->one.executor(), "node to program", pump(pair, pair->other, pair->one));
    net::spawn(pair->one.executor(), "watch", watch(pair));
    co_await pump(pair, pair->one, pair->other);
}

}  // namespace wall::wallagent
