// SPDX-License-Identifier: MIT
#include "tileserver/render/tile_watches.h"

#include <algorithm>

namespace wall::tileserver {

void TileWatches::add(const PictureRequest& request, std::chrono::microseconds interval) {
    watches_[request.id] = {request, interval};
}

void TileWatches::ready(PictureId stream, bool even_unchanged) {
    const auto at = watches_.find(stream);
    if (at == watches_.end()) return;
    at->second.ready = true;
    at->second.even_unchanged |= even_unchanged;
}

std::vector<PictureRequest> TileWatches::due(std::uint64_t damage, Clock::time_point now, std::size_t most) {
    std::vector<Watch*> wanted;
    for (auto& [stream, watch] : watches_)
        if (watch.wants(damage) && now >= watch.not_before) wanted.push_back(&watch);
    const auto taken = wanted.begin() + static_cast<std::ptrdiff_t>(std::min(most, wanted.size()));
    std::ranges::partial_sort(wanted, taken, {}, &Watch::not_before);
    wanted.erase(taken, wanted.end());
    std::vector<PictureRequest> out;
    for (Watch* watch : wanted) {
        watch->ready = watch->even_unchanged = false;
        watch->shown = damage;
        watch->not_before = now + watch->interval;
        out.push_back(watch->request);
    }
    return out;
}

TileWatches::Clock::duration TileWatches::next_due(std::uint64_t damage, Clock::time_point now) const {
    Clock::duration least = Clock::duration::max();
    for (const auto& [stream, watch] : watches_)
        if (watch.wants(damage)) least = std::min(least, std::max(Clock::duration{}, watch.not_before - now));
    return least;
}

}  // namespace wall::tileserver
