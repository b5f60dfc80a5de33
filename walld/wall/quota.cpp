// SPDX-License-Identifier: MIT
#include "walld/wall/quota.h"

namespace wall::walld {

Outcome<Quota::Place> Quota::take(const std::string& who, const QuotaAllowed& allowed) {
    const auto no = [&](const std::string& whose, std::size_t count) {
        return refuse(RefusalKind::busy, whose + " " + std::to_string(count) + " " + limits_.what +
                                             ", which is as many as there may be: try again later");
    };
    if (counts_->in_all >= limits_.in_all) return no("there are", counts_->in_all);
    const auto known = counts_->of.find(who);
    const std::size_t mine = known != counts_->of.end() ? known->second : 0;
    if (allowed.most && mine >= *allowed.most)
        return refuse(RefusalKind::busy, who + " has " + std::to_string(mine) + " " + limits_.what +
                                             ", as many as a person may have ('" + allowed.key +
                                             "' in [quota] of wall.toml)");
    if (mine >= limits_.of_one) return no(who + " has", mine);
    ++counts_->of[who];
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
