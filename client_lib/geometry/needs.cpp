// SPDX-License-Identifier: MIT
#include "client_lib/geometry/needs.h"

#include <algorithm>
#include <cstring>

#include "client_lib/geometry/block_walk.h"
#include "common/glstate/modelview.h"

namespace wall::client {
namespace {

using glstate::Category;
using glstate::CategoryMask;
using glstate::mask_of;

/// Never read by vertices: other drawing commands bring them up to date.
constexpr CategoryMask kNotForGeometry = mask_of(Category::pixel_transfer) | mask_of(Category::accumulation) |
                                         mask_of(Category::raster) | mask_of(Category::evaluator) |
                                         mask_of(Category::uniform_buffers) | mask_of(Category::shader_memory);
/// Read only while lighting is on.
constexpr CategoryMask kLit = mask_of(Category::material) | mask_of(Category::lights);

bool reads_normals(const glstate::State& state) {
    if (state.lighting.lighting_enabled) return true;
    const auto& generated = state.texture_gen;
    for (std::size_t i = 0; i < generated.tex_gen_enabled.size(); ++i) {
        const GLenum mode = generated.tex_gen_mode[i];
        if (generated.tex_gen_enabled[i] && mode != GL_OBJECT_LINEAR && mode != GL_EYE_LINEAR) return true;
    }
    return false;
}

}  // namespace

Needs needs_of_clear() {
    return {mask_of(Category::color_buffer) | mask_of(Category::accumulation) | mask_of(Category::depth_stencil) |
            mask_of(Category::multisample) | mask_of(Category::window) | mask_of(Category::objects)};
}

Needs needs_of_geometry(const glstate::State& state) {
    Needs needs;
    const auto& objects = state.objects;
    if (objects.current_program != 0) return needs;  // a shader may read anything
    if (objects.vertex_program_enabled != 0 || objects.fragment_program_enabled != 0) return needs;  // the same
    if (state.local.render_mode != GL_RENDER) return needs;
    needs.categories &= ~kNotForGeometry;
    if (!state.lighting.lighting_enabled) needs.categories &= ~kLit;
    if (!reads_normals(state)) {
        needs.spare(Attribute::normal);
        needs.categories &= ~mask_of(Category::modelview_origin);
    }
    return needs;
}

Needs needs_of_block(const glstate::State& state, const Packer& packer) {
    if (packer.has_rare() || packer.primitives().empty()) return {};
    Needs needs = needs_of_geometry(state);
    BlockWalk walk(packer, {}, packer.primitives().front().last, {});
    while (walk.next() && !walk.is_vertex()) {
    }
    for (std::size_t i = 0; i < kAttributes; ++i)
        if (walk.places().offset[i] != AttributePlaces::kNone) needs.spare(static_cast<Attribute>(i));
    return needs;
}

CategoryMask categories_to_send(const Needs& needs, const glstate::State& mirror, const glstate::State& state) {
    constexpr auto origin = static_cast<std::size_t>(Category::modelview_origin);
    if (!(needs.categories & mask_of(Category::modelview_origin)) || mirror.ids[origin] == state.ids[origin])
        return needs.categories;
    const auto& matrix = state.matrix.modelview;
    if (glstate::is_origin_of(state.modelview_origin.modelview_form, matrix)) return needs.categories;
    if (glstate::is_origin_of(mirror.modelview_origin.modelview_form, matrix)) return needs.categories;
    return needs.categories & ~mask_of(Category::modelview_origin);
}

void unify_id(glstate::State& mirror, const glstate::State& state, Category category) {
    const auto same_values = [&] {
        if (category == Category::current) return glstate::same(mirror.current, state.current);
        return category == Category::material && glstate::same(mirror.material, state.material);
    };
    const auto c = static_cast<std::size_t>(category);
    mirror.ids.take(c, same_values() ? state.ids[c] : glstate::next_value_id());
}

}  // namespace wall::client
