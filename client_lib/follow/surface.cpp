// SPDX-License-Identifier: MIT
#include "client_lib/follow/surface.h"

#include <atomic>

#include "client_lib/follow/hidden_part.h"
#include "client_lib/link/parallel.h"
#include "client_lib/objects/object.h"
#include "common/wire/limits.h"

namespace wall::client {

SurfaceId next_window_id() {
    static std::atomic<std::uint32_t> last{0};
    if (!parallel()) return next_surface_id();
    const auto number = ++last;
    return SurfaceId(number <= wire::kMaxSharedSurfaces ? number : 0);
}

ClientSurface::ClientSurface(SurfaceId own_id, SurfaceOptions own_options)
    : id(own_id), options(std::move(own_options)) {}
ClientSurface::~ClientSurface() = default;

}  // namespace wall::client
