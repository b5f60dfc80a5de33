// SPDX-License-Identifier: MIT
#include "client_lib/router.h"

#include <algorithm>
#include <cmath>

namespace wall::client {
namespace {

constexpr float kSmallestW = 1e-6f;

__m128 column(const glstate::Mat4& m, int c) { return _mm_loadu_ps(m.data() + 4 * c); }

__m128 transform(const glstate::Mat4& m, __m128 x, __m128 y, __m128 z, __m128 w) {
    return _mm_add_ps(_mm_add_ps(_mm_mul_ps(column(m, 0), x), _mm_mul_ps(column(m, 1), y)),
                      _mm_add_ps(_mm_mul_ps(column(m, 2), z), _mm_mul_ps(column(m, 3), w)));
}

WindowVertex to_window(const Projection& p, __m128 clip) {
    alignas(16) float c[4];
    _mm_store_ps(c, clip);
    if (!(c[3] > kSmallestW)) return {0, 0, false};
    const float x = c[0] / c[3], y = c[1] / c[3];
    if (!std::isfinite(x) || !std::isfinite(y)) return {0, 0, false};
    return {p.viewport[0] + (x + 1) * 0.5f * p.viewport[2], p.viewport[1] + (y + 1) * 0.5f * p.viewport[3], true};
}

}  // namespace

glstate::Mat4 multiply(const glstate::Mat4& a, const glstate::Mat4& b) {
    glstate::Mat4 out;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            out[4 * c + r] = a[r] * b[4 * c] + a[4 + r] * b[4 * c + 1] + a[8 + r] * b[4 * c + 2] + a[12 + r] * b[4 * c + 3];
    return out;
}

Projection make_projection(const glstate::State& state) {
    Projection p;
    p.clip_from_object = multiply(state.matrix.projection, state.matrix.modelview);
    const auto& v = state.window.viewport;
    const int viewport[4] = {v.x, v.y, v.width, v.height};
    for (int i = 0; i < 4; ++i) p.viewport[i] = static_cast<float>(viewport[i]);
    const auto& lp = state.line_point;
    const bool attenuated = lp.point_distance_attenuation != glstate::Vec3{1, 0, 0};
    const float point = attenuated || lp.program_point_size ? lp.point_size_max : lp.point_size;
    p.margin = 1 + std::max(lp.line_width, point) / 2;
    return p;
}

std::optional<PixelRect> project(const Projection& p, const geom::Box& box) {
    if (box.unbounded()) return std::nullopt;
    alignas(16) float lo[4], hi[4];
    _mm_store_ps(lo, box.min);
    _mm_store_ps(hi, box.max);
    PixelRect rect{INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (int corner = 0; corner < 8; ++corner) {
        const __m128 x = _mm_set1_ps(corner & 1 ? hi[0] : lo[0]);
        const __m128 y = _mm_set1_ps(corner & 2 ? hi[1] : lo[1]);
        const __m128 z = _mm_set1_ps(corner & 4 ? hi[2] : lo[2]);
        const WindowVertex v = to_window(p, transform(p.clip_from_object, x, y, z, _mm_set1_ps(1)));
        if (!v.known) return std::nullopt;
        rect.x0 = std::min(rect.x0, v.x);
        rect.x1 = std::max(rect.x1, v.x);
        rect.y0 = std::min(rect.y0, v.y);
        rect.y1 = std::max(rect.y1, v.y);
    }
    return PixelRect{rect.x0 - p.margin, rect.y0 - p.margin, rect.x1 + p.margin, rect.y1 + p.margin};
}

WindowVertex project(const Projection& p, float x, float y, float z, float w) {
    return to_window(p, transform(p.clip_from_object, _mm_set1_ps(x), _mm_set1_ps(y), _mm_set1_ps(z), _mm_set1_ps(w)));
}

TargetSet targets_of(const SurfaceLayout& layout, const std::optional<PixelRect>& rect) {
    TargetSet set;
    for (std::size_t i = 0; i < layout.targets.size(); ++i)
        if (!rect || rect->overlaps(layout.targets[i].area)) set.set(i);
    return set;
}

}  // namespace wall::client
