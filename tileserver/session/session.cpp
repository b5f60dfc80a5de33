// SPDX-License-Identifier: MIT
#include "tileserver/session/session.h"

namespace wall::tileserver {

SurfaceReplica* SessionReplica::surface(SurfaceId id) {
    if (shares(id)) return group_->surface(id);
    const auto at = surfaces_.find(id);
    return at == surfaces_.end() ? nullptr : at->second.get();
}

SurfaceReplica* SessionReplica::create_surface(SurfaceId id, const SurfaceFormat& format) {
    driver_.forget_target();
    partials_.erase(id);
    if (shares(id)) return group_->open_surface(rank_, id, format);
    if (surfaces_.size() >= kMaxSurfaces && !surfaces_.contains(id)) return nullptr;
    auto& surface = surfaces_[id];
    surface = std::make_unique<SurfaceReplica>(driver_.gl(), driver_.flip_y(), format, pixels_);
    return surface.get();
}

void SessionReplica::destroy_surface(SurfaceId id) {
    driver_.forget_target();
    partials_.erase(id);
    if (shares(id)) return group_->close_surface(rank_, id);
    surfaces_.erase(id);
}

}  // namespace wall::tileserver
