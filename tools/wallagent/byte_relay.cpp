// SPDX-License-Identifier: MIT
#include "tools/wallagent/byte_relay.h"

#include "common/daemon/keep_running.h"

namespace wall::wallagent {
namespace {

constexpr std::size_t kRoom = std::size_t{256} << 10;  // bytes, each way

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
    co_await pump(pair, pair->one, pair->other);
}

}  // namespace wall::wallagent
