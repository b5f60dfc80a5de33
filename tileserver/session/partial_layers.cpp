// SPDX-License-Identifier: MIT
#include "tileserver/session/partial_layers.h"

#include <algorithm>
#include <utility>

#include "tileserver/session/surface.h"

namespace wall::tileserver {

bool PartialLayers::open(SurfaceReplica& surface, GLenum by, std::vector<One> wanted) {
    by_ = by;
    opened_ = std::chrono::steady_clock::now();
    bool affordable = true;
    for (One& one : wanted) {
        const LayerGeometry geometry = surface.geometry_of_part(one.area);
        const auto same = std::ranges::find_if(
            all_, [&](const One& old) { return old.layer != nullptr && old.layer->geometry() == geometry; });
        one.layer = same != all_.end() ? std::move(same->layer) : surface.make_partial(geometry);
        affordable = affordable && one.layer != nullptr;
    }
    all_ = std::move(wanted);
    return affordable;
}

Layer* PartialLayers::draw_to(unsigned number) {
    if (number >= all_.size()) return nullptr;
    all_[number].drawn = true;
    return all_[number].layer.get();
}

}  // namespace wall::tileserver
