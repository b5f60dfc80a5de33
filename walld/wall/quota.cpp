// SPDX-License-Identifier: MIT
#include "walld/wall/quota.h"

namespace wall::walld {

Outcome<Quota::Place> Quota::take(const std::string& who) {
    const auto no = [&](const std::string& whose, std::size_t count) {
        return refuse(RefusalKind::busy, whose + " " + std::to_string(count) + " " + limits_.what +
                                             ", which is as many as there may be: try again later");
    };
    if (counts_->in_all >= limits_.in_all) return no("there are", counts_->in_all);
    auto& mine = counts_->of[who];
    if (mine >= limits_.of_one) return no(who + " has", mine);
    ++mine;
    ++counts_->in_all;
    return Place(counts_, who);
}

void Quota::Place::leave() {
    const auto counts = std::exchange(counts_, nullptr);
    if (!counts) return;
    --counts->in_all;
    const auto mine = counts->of.find(who_);
    if (--mine->second == 0) counts->of.erase(mine);
}

}  // namespace wall::walld
