// SPDX-License-Identifier: MIT
#include "tileserver/driver/window_values.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/glstate/indexed_values.h"

namespace wall::tileserver {
namespace {

/// The pattern is anchored at the window's corner; the layer's corner lies elsewhere.
std::array<std::uint32_t, 32> rotate_stipple(const std::array<std::uint32_t, 32>& words, std::int32_t dx,
                                             std::int32_t dy) {
    std::array<std::uint32_t, 32> out{};
    for (std::uint32_t row = 0; row < 32; ++row) {
        const std::uint32_t from = words[(row + static_cast<std::uint32_t>(dy)) % 32];
        // Byte 0 holds the leftmost eight pixels, its highest bit the first of them.
        const std::uint32_t left_first = __builtin_bswap32(from);
        out[row] = __builtin_bswap32(std::rotl(left_first, dx & 31));
    }
    return out;
}

/// Null: the first one's.
template <class R>
const typename R::type* own_value(const glstate::State& state, unsigned index) {
    const typename R::type& value = R::ref(state, index - 1);
    return glstate::same(value, glstate::as_the_first<typename R::type>()) ? nullptr : &value;
}

/// Rounds an edge; saturates where a program gave an absurd rectangle.
std::int32_t round_edge(double value) {
    return static_cast<std::int32_t>(std::clamp(std::floor(value + 0.5), -1e9, 1e9));
}

}  // namespace

LayerPoint layer_point(const LayerGeometry& g, double x, double y) {
    if (!g.scaled()) return {x - g.offset_x(), y - g.offset_y()};
    return {x * g.scale_x() - g.offset_x(), y * g.scale_y() - g.offset_y()};
}

LayerEdge layer_edge(const LayerGeometry& g, double x, double y) {
    return {round_edge(x * g.scale_x()) - g.offset_x(), round_edge(y * g.scale_y()) - g.offset_y()};
}

WindowValues::IntBox layer_box(const LayerGeometry& g, const WindowValues::IntBox& w) {
    const auto low = layer_edge(g, w.x, w.y),
               high = layer_edge(g, static_cast<double>(w.x) + w.width, static_cast<double>(w.y) + w.height);
    return {low.x, low.y, std::max(high.x - low.x, 0), std::max(high.y - low.y, 0)};
}

namespace {

/// What is no number, or absurd, is 0.
float sane(double value) { return std::abs(value) <= 1e9 ? static_cast<float>(value) : 0; }

WindowValues::Box viewport_of(const LayerGeometry& g, const glstate::Viewport& viewport) {
    const auto at = layer_point(g, viewport.x, viewport.y);
    return {sane(at.x), sane(at.y), sane(viewport.width * g.scale_x()), sane(viewport.height * g.scale_y())};
}

WindowValues::IntBox scissor_of(const LayerGeometry& g, const glstate::Scissor& scissor) {
    return layer_box(g, {scissor.x, scissor.y, scissor.width, scissor.height});
}

/// Scissors that leave everything else as it is.
void keep_to(const geom::Rect& part, WindowValues& values) {
    for (unsigned i = 0; i < WindowValues::kViewports; ++i) {
        WindowValues::IntBox& box = values.scissors[i];
        const bool enabled = (values.scissor_enabled >> i & 1) != 0;
        const geom::Rect both = enabled ? geom::intersect(part, {box.x, box.y, box.width, box.height}) : part;
        box = {both.x, both.y, both.width, both.height};
    }
    values.scissor_enabled = (1u << WindowValues::kViewports) - 1;
}

}  // namespace

WindowValues window_values(const LayerGeometry& g, const glstate::State& state) {
    namespace el = glstate::el;
    WindowValues out;
    out.viewports.fill(viewport_of(g, el::viewport::ref(state)));
    out.scissors.fill(scissor_of(g, el::scissor::ref(state)));
    if (!glstate::none_has_its_own<el::viewport_rest>(state) || !glstate::none_has_its_own<el::scissor_rest>(state))
        for (unsigned i = 1; i < WindowValues::kViewports; ++i) {
            if (const auto* own = own_value<el::viewport_rest>(state, i)) out.viewports[i] = viewport_of(g, *own);
            if (const auto* own = own_value<el::scissor_rest>(state, i)) out.scissors[i] = scissor_of(g, *own);
        }
    out.scissor_enabled = el::scissor_enabled::ref(state);
    if (g.part) {
        const WindowValues::IntBox part = layer_box(g, {g.part->x, g.part->y, g.part->width, g.part->height});
        keep_to({part.x, part.y, part.width, part.height}, out);
    }
    out.stipple = rotate_stipple(el::polygon_stipple::ref(state), g.offset_x(), g.offset_y());
    const auto& zoom = el::pixel_zoom::ref(state);
    out.pixel_zoom = {static_cast<float>(zoom.x * g.scale_x()), static_cast<float>(zoom.y * g.scale_y())};
    return out;
}

}  // namespace wall::tileserver
