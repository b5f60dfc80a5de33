// SPDX-License-Identifier: MIT
#include "client_lib/follow/draw_target.h"

#include "client_lib/follow/hidden_part.h"
#include "common/wire/whole_window.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

/// What a node is told of the layer of the whole window.
std::uint32_t whole_window_of(const Node& node, const ClientSurface& surface) {
    if (surface.layout.offscreen) return wire::kOnlyWholeWindow;
    return surface.hidden && surface.hidden->layer.node == node.index ? wire::kAlsoWholeWindow : wire::kTilesOnly;
}

}  // namespace

void DrawTarget::describe_to(Node& node) const {
    const SurfaceLayout& layout = surface_->layout;
    const auto known = node.surfaces.find(surface_->id);
    if (known == node.surfaces.end()) {
        const SurfaceFormat& f = format();
        glapi::pack::SurfaceCreate(node.batch, surface_->id, f.double_buffered, f.alpha_bits, f.depth_bits,
                                   f.stencil_bits, f.accum_bits, f.samples);
    } else if (known->second == layout.version) {
        return;
    }
    glapi::pack::SurfacePlace(node.batch, surface_->id, layout.version, layout.width, layout.height, layout.rect.x,
                              layout.rect.y, static_cast<std::uint32_t>(layout.rect.width),
                              static_cast<std::uint32_t>(layout.rect.height), whole_window_of(node, *surface_));
    node.surfaces[surface_->id] = layout.version;
}

void bind_targets(Node& node, Mirror& mirror, const DrawTarget& draw, const DrawTarget& read) {
    draw.describe_to(node);
    if (read.surface_ != draw.surface_) read.describe_to(node);
    const SurfaceId to = draw.surface_->id, from = read.surface_->id;
    if (mirror.draw_surface == to && mirror.read_surface == from) return;
    glapi::pack::Bind(node.batch, to, from);
    mirror.draw_surface = to;
    mirror.read_surface = from;
}

}  // namespace wall::client
