// SPDX-License-Identifier: MIT
#include "tools/wallagent/byte_relay.h"

#include "common/daemon/keep_running.h"
#include "common/log/log.h"

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

/// A link that is cut is given up: the program comes to the node over another connection, as soon as there is a link.
/// False: there is nothing left to look at.
bool still_moves(const std::weak_ptr<Pair>& weak) {
    const auto pair = weak.lock();
    if (!pair || !pair->other.is_open()) return false;
    if (!pair->other.is_stuck()) return true;
    log::warn("node_stuck node={}", log::quoted(net::peer_text(pair->other.descriptor())));
    pair->one.close();
    pair->other.close();
    return false;
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
    net::look_again(pair->one.executor(), "watch", net::Stream::kLookForStuck,
                    [weak = std::weak_ptr(pair)] { return still_moves(weak); });
    co_await pump(pair, pair->one, pair->other);
}

}  // namespace wall::wallagent
