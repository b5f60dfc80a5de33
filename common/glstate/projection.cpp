// SPDX-License-Identifier: MIT
#include "common/glstate/projection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/glapi/primitive.h"

namespace wall::glstate {
namespace {

constexpr float kSmallestW = 1e-6f;
constexpr float kLargestCoordinate = 1e30f;  ///< of clip space; beyond it differences overflow
constexpr float kRounding = 1e-6f;           ///< of a clip coordinate, relative to the largest

__m128 column(const Mat4& m, int c) { return _mm_loadu_ps(m.data() + 4 * c); }

__m128 transform(const Mat4& m, __m128 x, __m128 y, __m128 z, __m128 w) {
    return _mm_add_ps(_mm_add_ps(_mm_mul_ps(column(m, 0), x), _mm_mul_ps(column(m, 1), y)),
                      _mm_add_ps(_mm_mul_ps(column(m, 2), z), _mm_mul_ps(column(m, 3), w)));
}

WindowVertex to_window(const Projection& p, __m128 clip) {
    WindowVertex v;
    _mm_storeu_ps(v.clip.data(), clip);
    v.in_front = v.clip[3] > kSmallestW;
    v.x = p.viewport[0] + (v.clip[0] / v.clip[3] + 1) * 0.5f * p.viewport[2];
    v.y = p.viewport[1] + (p.y_up * v.clip[1] / v.clip[3] + 1) * 0.5f * p.viewport[3];
    return v;
}

constexpr PixelRect kNowhere{INFINITY, INFINITY, -INFINITY, -INFINITY};

void grow(PixelRect& rect, const WindowVertex& v) {
    rect.x0 = std::min(rect.x0, v.x);
    rect.x1 = std::max(rect.x1, v.x);
    rect.y0 = std::min(rect.y0, v.y);
    rect.y1 = std::max(rect.y1, v.y);
}

/// What is in front of the plane where `distance` is 0: the vertices there, and where edges cross it. Nothing if a
/// crossing is not in front of the eye.
template <class Distance>
std::optional<PixelRect> clipped_rect(const Projection& p, std::span<const WindowVertex> vertices,
                                      Distance&& distance) {
    PixelRect rect = kNowhere;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const float di = distance(vertices[i]);
        if (di >= 0) {
            if (!vertices[i].in_front) return std::nullopt;
            grow(rect, vertices[i]);
        }
        for (std::size_t j = 0; j < i; ++j) {
            const float dj = distance(vertices[j]);
            if ((di >= 0) == (dj >= 0)) continue;
            const __m128 from = _mm_loadu_ps(vertices[i].clip.data()), to = _mm_loadu_ps(vertices[j].clip.data());
            const WindowVertex cut =
                to_window(p, _mm_add_ps(from, _mm_mul_ps(_mm_set1_ps(di / (di - dj)), _mm_sub_ps(to, from))));
            if (!cut.in_front) return std::nullopt;
            grow(rect, cut);
        }
    }
    return rect;
}

}  // namespace

Mat4 multiply(const Mat4& a, const Mat4& b) {
    Mat4 out;
    for (int c = 0; c < 4; ++c) {
        const float* from = b.data() + 4 * c;
        __m128 sum = _mm_mul_ps(column(a, 0), _mm_set1_ps(from[0]));
        for (int i = 1; i < 4; ++i) sum = _mm_add_ps(sum, _mm_mul_ps(column(a, i), _mm_set1_ps(from[i])));
        _mm_storeu_ps(out.data() + 4 * c, sum);
    }
    return out;
}

Projection make_projection(const State& state) {
    Projection p;
    p.clip_from_object = multiply(state.matrix.projection, state.matrix.modelview);
    p.camera = state.matrix.projection;
    const auto& v = state.window.viewport;
    const float viewport[4] = {v.x, v.y, v.width, v.height};
    std::copy_n(viewport, 4, p.viewport);
    p.y_up = state.transform.clip_control.origin == GL_LOWER_LEFT ? 1.0f : -1.0f;
    p.near_is_zero = state.transform.clip_control.depth == GL_ZERO_TO_ONE;
    const auto& lp = state.line_point;
    const bool attenuated = lp.point_distance_attenuation != glstate::Vec3{1, 0, 0};
    const float point = attenuated || lp.program_point_size ? lp.point_size_max : lp.point_size;
    p.reaches = {1 + point / 2, 1 + lp.line_width / 2, 1};
    for (const GLenum drawn_as : state.polygon.polygon_mode)
        if (drawn_as != GL_FILL)
            p.reaches.polygons = std::max(p.reaches.polygons, drawn_as == GL_LINE ? p.reaches.lines : p.reaches.points);
    p.margin = std::max(p.reaches.lines, p.reaches.points);
    p.near_plane = !state.transform.depth_clamp;
    return p;
}

Projection make_projection(const Projection& fixed_function, const glapi::PositionTransform& transform, bool depth) {
    Projection p = fixed_function;
    p.clip_from_object = transform.matrix();
    p.near_plane = p.near_plane && depth;
    p.by_shader = true;
    p.sizes = transform.sizes;
    return p;
}

void set_camera(Projection& projection, std::span<const float> camera) {
    projection.camera = {};
    std::ranges::copy(camera.first(std::min(camera.size(), projection.camera.size())), projection.camera.begin());
}

Projection unknown_projection(const Mat4& camera) {
    Projection p;
    p.camera = camera;
    p.clip_from_object[12] = 10 * kLargestCoordinate;
    p.unknown_elsewhere = true;
    return p;
}

namespace {

struct ClipCorners {
    __m128 at[8];
};

/// The corners of a box in clip space.
ClipCorners clip_corners(const Projection& p, const geom::Box& box) {
    alignas(16) float lo[4], hi[4];
    _mm_store_ps(lo, box.min);
    _mm_store_ps(hi, box.max);
    const auto part = [&](int axis, const float* from) {
        return _mm_mul_ps(column(p.clip_from_object, axis), _mm_set1_ps(from[axis]));
    };
    const __m128 x[2] = {part(0, lo), part(0, hi)}, y[2] = {part(1, lo), part(1, hi)};
    const __m128 origin = column(p.clip_from_object, 3);
    const __m128 z[2] = {_mm_add_ps(part(2, lo), origin), _mm_add_ps(part(2, hi), origin)};
    ClipCorners out;
    for (unsigned corner = 0; corner < 8; ++corner)
        out.at[corner] = _mm_add_ps(_mm_add_ps(x[corner & 1], y[corner >> 1 & 1]), z[corner >> 2]);
    return out;
}

/// hull_rect() of corners that are all in front of the eye, and numbers of a usual size; else nothing.
std::optional<PixelRect> rect_in_front(const Projection& p, const ClipCorners& corners) {
    const __m128 sign = _mm_set1_ps(-0.0f), largest = _mm_set1_ps(kLargestCoordinate),
                 smallest = _mm_set1_ps(kSmallestW);
    __m128 fine = _mm_cmpeq_ps(sign, sign), least = _mm_set1_ps(INFINITY), most = _mm_set1_ps(-INFINITY);
    for (const __m128& clip : corners.at) {
        const __m128 w = _mm_shuffle_ps(clip, clip, _MM_SHUFFLE(3, 3, 3, 3));
        fine =
            _mm_and_ps(fine, _mm_and_ps(_mm_cmplt_ps(_mm_andnot_ps(sign, clip), largest), _mm_cmpgt_ps(w, smallest)));
        const __m128 device = _mm_div_ps(clip, w);
        least = _mm_min_ps(least, device);
        most = _mm_max_ps(most, device);
    }
    if (_mm_movemask_ps(fine) != 0xf) return std::nullopt;
    alignas(16) float low[4], high[4];
    _mm_store_ps(low, least);
    _mm_store_ps(high, most);
    const auto pixel = [&](int axis, float device) {
        return p.viewport[axis] + (device + 1) * 0.5f * p.viewport[2 + axis];
    };
    if (p.y_up < 0) low[1] = -std::exchange(high[1], -low[1]);
    return PixelRect{pixel(0, low[0]) - p.margin, pixel(1, low[1]) - p.margin, pixel(0, high[0]) + p.margin,
                     pixel(1, high[1]) + p.margin};
}

/// How far what a shader makes of the box's corners may lie from what is computed here, in clip space. Some three
/// products of matrices, each of sums of four, there and here: 32 roundings.
std::array<float, 4> shader_errors(const Projection& p, const geom::Box& box) {
    constexpr float kRoundings = 32 * 0x1p-24f;
    alignas(16) float low[4], high[4];
    _mm_store_ps(low, box.min);
    _mm_store_ps(high, box.max);
    std::array<float, 4> out{};
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const float reach = axis == 3 ? 1 : std::max(std::abs(low[axis]), std::abs(high[axis]));
        for (std::size_t row = 0; row < 4; ++row) out[row] += kRoundings * reach * p.sizes[4 * axis + row];
    }
    return out;
}

/// The rectangle of a box with these corners, widened by as much. Nothing: a corner may be anywhere.
std::optional<PixelRect> widen(const Projection& p, const geom::Box& box, const ClipCorners& corners,
                               const PixelRect& rect) {
    constexpr float kUsual = 1e-4f;  // of the largest coordinate; what fixed function is taken to be exact at
    const auto errors = shader_errors(p, box);
    float nearest = INFINITY, largest = 0;
    for (const __m128& corner : corners.at) {
        alignas(16) float clip[4];
        _mm_store_ps(clip, corner);
        nearest = std::min(nearest, clip[3]);
        for (const float c : clip) largest = std::max(largest, std::abs(c));
    }
    if (!(nearest > 2 * errors[3])) {  // around the eye, errors in pixels have no bound
        return *std::max_element(errors.begin(), errors.end()) <= kUsual * largest ? std::optional(rect) : std::nullopt;
    }
    PixelRect out = rect;
    const auto grow = [&](int axis, float& from, float& to) {
        const float half = p.viewport[2 + axis] / 2, middle = p.viewport[axis] + half;
        const float reach = std::max(std::abs(from - middle), std::abs(to - middle));
        const float by = (errors[static_cast<std::size_t>(axis)] * half + reach * errors[3]) / (nearest - errors[3]);
        from -= by;
        to += by;
    };
    grow(0, out.x0, out.x1);
    grow(1, out.y0, out.y1);
    return out;
}

std::optional<PixelRect> project(const Projection& p, const ClipCorners& clip) {
    if (const auto rect = rect_in_front(p, clip)) return rect;
    std::array<WindowVertex, 8> corners;
    for (unsigned corner = 0; corner < corners.size(); ++corner) corners[corner] = to_window(p, clip.at[corner]);
    return hull_rect(p, corners);
}

}  // namespace

std::optional<PixelRect> project(const Projection& p, const geom::Box& box) {
    if (box.unbounded()) return std::nullopt;
    const auto clip = clip_corners(p, box);
    const auto rect = project(p, clip);
    return rect && p.by_shader ? widen(p, box, clip, *rect) : rect;
}

std::optional<PixelRect> project(const Projection& p, const geom::Box& box, GLenum mode) {
    auto rect = project(p, box);
    if (!rect) return rect;
    const float less = p.margin - p.reaches.of(mode);
    return PixelRect{rect->x0 + less, rect->y0 + less, rect->x1 - less, rect->y1 - less};
}

float Reaches::of(GLenum mode) const {
    switch (glapi::single_primitive(mode)) {
        case GL_POINTS: return points;
        case GL_LINES:
        case GL_LINES_ADJACENCY: return lines;
        default: return polygons;
    }
}

std::optional<PixelRect> hull_rect(const Projection& p, std::span<const WindowVertex> vertices) {
    std::optional<PixelRect> rect = kNowhere;
    bool in_front = true;
    float largest = 0;  // coordinate
    for (const WindowVertex& v : vertices) {
        in_front = in_front && v.in_front;
        grow(*rect, v);
        for (const float c : v.clip) largest = std::max(largest, std::abs(c));
    }
    if (!(largest < kLargestCoordinate)) return std::nullopt;  // or not a number
    if (!in_front) {
        const float slack = largest * kRounding;
        rect.reset();
        if (p.near_plane)
            rect = clipped_rect(p, vertices, [&](const WindowVertex& v) {
                return v.clip[2] + (p.near_is_zero ? 0.0f : v.clip[3]) + slack;
            });
        if (!rect) rect = clipped_rect(p, vertices, [](const WindowVertex& v) { return v.clip[3] - 2 * kSmallestW; });
        if (!rect) return std::nullopt;
    }
    return PixelRect{rect->x0 - p.margin, rect->y0 - p.margin, rect->x1 + p.margin, rect->y1 + p.margin};
}

WindowVertex project(const Projection& p, float x, float y, float z, float w) {
    return to_window(p, transform(p.clip_from_object, _mm_set1_ps(x), _mm_set1_ps(y), _mm_set1_ps(z), _mm_set1_ps(w)));
}

WindowVertex moved(const Projection& p, const WindowVertex& vertex, const Mat4& change) {
    const auto& clip = vertex.clip;
    return to_window(
        p, transform(change, _mm_set1_ps(clip[0]), _mm_set1_ps(clip[1]), _mm_set1_ps(clip[2]), _mm_set1_ps(clip[3])));
}

}  // namespace wall::glstate
