// SPDX-License-Identifier: MIT
#include "tileserver/kms/pairing.h"

namespace wall::tileserver {
namespace {

constexpr auto kNobody = ~std::size_t{};

struct Search {
    std::span<const std::vector<std::size_t>> candidates;
    std::vector<std::size_t> owner;  // of each number; kNobody: it is free
    std::vector<bool> tried;         // numbers, for the one that is looked for now

    /// True: `who` has a number now, and everybody who had one still has one.
    bool place(std::size_t who) {
        for (const std::size_t number : candidates[who]) {
            if (tried[number]) continue;
            tried[number] = true;
            if (owner[number] != kNobody && !place(owner[number])) continue;
            owner[number] = who;
            return true;
        }
        return false;
    }
};

}  // namespace

std::optional<std::vector<std::size_t>> pair_up(std::span<const std::vector<std::size_t>> candidates,
                                                std::size_t count) {
    Search search{candidates, std::vector<std::size_t>(count, kNobody), {}};
    for (std::size_t who = 0; who < candidates.size(); ++who) {
        search.tried.assign(count, false);
        if (!search.place(who)) return {};
    }
    std::vector<std::size_t> out(candidates.size());
    for (std::size_t number = 0; number < count; ++number)
        if (search.owner[number] != kNobody) out[search.owner[number]] = number;
    return out;
}

}  // namespace wall::tileserver
