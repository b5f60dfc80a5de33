// SPDX-License-Identifier: MIT
#include "client_lib/geometry/snap.h"

#include <emmintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>

#include "client_lib/geometry/block_walk.h"

namespace wall::client {
namespace {

constexpr std::uint32_t kExponent = 0x7f800000;  ///< bits of a float
constexpr int kNormalBits = 9;                   ///< of a normal's largest component that are kept
constexpr float kRounding = 1e-6f;               ///< of a w, relative to what it is a sum of
constexpr float kSmallestStep = 1e-30f, kLargestStep = 1e30f;

/// The largest power of two that is not more.
float power_below(float value) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) & kExponent); }

/// To the nearest multiples of a power of two: adding makes the sum's last bit worth one step. What is too large for
/// that, or no number, stays.
__m128 to_multiples(__m128 values, float step) {
    const __m128 round = _mm_set1_ps(step * 0x1.8p23f);
    const __m128 rounded = _mm_sub_ps(_mm_add_ps(values, round), round);
    const __m128 size = _mm_andnot_ps(_mm_set1_ps(-0.0f), values);
    const __m128 small = _mm_cmplt_ps(size, _mm_set1_ps(step * 0x1p22f));
    return _mm_or_ps(_mm_and_ps(small, rounded), _mm_andnot_ps(small, values));
}

void snap_normal(std::byte* at) {
    std::array<float, 4> values{};
    std::memcpy(values.data(), at, 3 * sizeof(float));
    const float largest = std::max({std::abs(values[0]), std::abs(values[1]), std::abs(values[2])});
    const float step = std::ldexp(power_below(largest), -kNormalBits);
    if (!(step > kSmallestStep && step < kLargestStep)) return;
    _mm_storeu_ps(values.data(), to_multiples(_mm_loadu_ps(values.data()), step));
    std::memcpy(at, values.data(), 3 * sizeof(float));
}

/// The last row of the inverse, times the determinant, and that. By cofactors: no row is needed but this.
struct LastRow {
    std::array<double, 4> row;
    double determinant;
};
LastRow last_row_of_inverse(const glstate::Mat4& m) {
    const auto at = [&](int row, int column) {
        return static_cast<double>(m[static_cast<std::size_t>(4 * column + row)]);
    };
    LastRow out{};
    for (int row = 0; row < 4; ++row) {
        std::array<int, 3> rows{};
        for (int r = 0, n = 0; r < 4; ++r)
            if (r != row) rows[static_cast<std::size_t>(n++)] = r;
        const auto [a, b, c] = rows;
        const double minor = at(a, 0) * (at(b, 1) * at(c, 2) - at(b, 2) * at(c, 1)) -
                             at(a, 1) * (at(b, 0) * at(c, 2) - at(b, 2) * at(c, 0)) +
                             at(a, 2) * (at(b, 0) * at(c, 1) - at(b, 1) * at(c, 0));
        out.row[static_cast<std::size_t>(row)] = row % 2 == 0 ? -minor : minor;
        out.determinant += out.row[static_cast<std::size_t>(row)] * at(row, 3);
    }
    return out;
}

/// The least w of what lies in the picture: what comes out at a corner of it with w' has had the w 1 / w'. 0: there is
/// no such thing.
float nearest_w(const glstate::Projection& projection) {
    const auto [row, determinant] = last_row_of_inverse(projection.clip_from_object);
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const double near_z = projection.near_is_zero ? 0 : -1;
        most = std::max(most, ((corner & 1 ? row[0] : -row[0]) + (corner & 2 ? row[1] : -row[1]) +
                               row[2] * (corner & 4 ? 1 : near_z) + row[3]) /
                                  determinant);
    }
    const auto w = static_cast<float>(1 / most);
    return most > 0 && std::isfinite(most) && w > 0 ? w : 0;
}

}  // namespace

std::optional<SnapGrid> SnapGrid::make(const glstate::Projection& projection, std::array<float, 2> scale,
                                       float pixels) {
    if (projection.by_shader || projection.unknown_elsewhere || !projection.near_plane) return std::nullopt;
    SnapGrid out;
    const auto& m = out.clip_ = projection.clip_from_object;
    out.w_row_ = _mm_setr_ps(m[3], m[7], m[11], m[15]);
    out.half_size_ = {0.5 * static_cast<double>(projection.viewport[2] * scale[0]),
                      0.5 * static_cast<double>(projection.viewport[3] * scale[1])};
    out.nearest_w_ = nearest_w(projection);
    if (out.nearest_w_ == 0) return std::nullopt;
    // An error of h / 2 in each coordinate moves clip coordinate i by h / 2 times the sum of row i at most, and what
    // is seen at (x, y) with |x|, |y| <= w by that of x and of w together, over w. Both axes share the bound.
    const auto sum = [&](std::size_t row) { return std::abs(m[row]) + std::abs(m[row + 4]) + std::abs(m[row + 8]); };
    float step = std::numeric_limits<float>::infinity();
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const float moved = (sum(axis) + sum(3)) / 2 * static_cast<float>(out.half_size_[axis]);
        step = std::min(step, pixels / std::numbers::sqrt2_v<float> / moved);
    }
    if (!(step > kSmallestStep && step < kLargestStep)) return std::nullopt;
    out.step_ = step;
    return out;
}

float SnapGrid::w_at(__m128 vertex) const {
    const __m128 products = _mm_mul_ps(vertex, w_row_);
    const __m128 pairs = _mm_add_ps(products, _mm_movehl_ps(products, products));
    return _mm_cvtss_f32(_mm_add_ss(pairs, _mm_shuffle_ps(pairs, pairs, 1)));
}

__m128 SnapGrid::snapped(__m128 vertex, float reach) const {
    const float w = w_at(vertex);
    const float nearest = w > 0 ? std::min(w, nearest_w_) : nearest_w_;
    const float step = power_below(step_ * (w > reach ? w : nearest));
    if (!(step > kSmallestStep && step < kLargestStep)) return vertex;
    const __m128 position = _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0));
    return _mm_or_ps(_mm_and_ps(position, to_multiples(vertex, step)), _mm_andnot_ps(position, vertex));
}

std::optional<double> SnapGrid::distance(__m128 a, __m128 b) const {
    std::array<std::array<double, 2>, 2> seen{};
    for (std::size_t i = 0; i < 2; ++i) {
        std::array<float, 4> from{};
        _mm_storeu_ps(from.data(), i == 0 ? a : b);
        std::array<double, 4> clip{};
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t column = 0; column < 4; ++column)
                clip[row] += static_cast<double>(clip_[4 * column + row]) * static_cast<double>(from[column]);
        if (clip[3] < static_cast<double>(nearest_w_) || std::max(std::abs(clip[0]), std::abs(clip[1])) > clip[3])
            return std::nullopt;
        seen[i] = {clip[0] / clip[3] * half_size_[0], clip[1] / clip[3] * half_size_[1]};
    }
    return std::hypot(seen[0][0] - seen[1][0], seen[0][1] - seen[1][1]);
}

std::array<float, 2> SnapGrid::w_of(const geom::Box& box) const {
    std::array<float, 4> row{}, least{}, most{};
    _mm_storeu_ps(row.data(), w_row_);
    const __m128 a = _mm_mul_ps(box.min, w_row_), b = _mm_mul_ps(box.max, w_row_);
    _mm_storeu_ps(least.data(), _mm_min_ps(a, b));
    _mm_storeu_ps(most.data(), _mm_max_ps(a, b));
    float rounding = std::abs(row[3]);
    for (std::size_t i = 0; i < 3; ++i) rounding += std::max(std::abs(least[i]), std::abs(most[i]));
    rounding *= kRounding;
    return {least[0] + least[1] + least[2] + row[3] - rounding, most[0] + most[1] + most[2] + row[3] + rounding};
}

float reach_behind(const Packer& packer, const SnapGrid& grid) {
    if (grid.w_of(packer.block_box())[0] > 0) return 0;
    float reach = 0;
    for (const Primitive& primitive : packer.primitives()) {
        const auto [least, most] = grid.w_of(primitive.box);
        if (!(least > 0)) reach = std::max(reach, most);
    }
    return reach;
}

Snapped snap(wire::PackBuffer& buffer, wire::PackMark first, wire::PackMark last, const SnapGrid& grid, float reach,
             bool measure) {
    Snapped out;
    std::byte* waiting = nullptr;  // a normal that may be the last
    std::size_t operand = first.operand_bytes;
    for (std::size_t i = first.commands; i < last.commands; ++i) {
        const auto op = static_cast<glapi::Op>(buffer.opcode_at(i));
        std::byte* const at = buffer.operand_at(operand);
        const std::size_t bytes = operand_bytes_of(op);
        operand += bytes;
        if (op == glapi::Op::Normal3f) {
            if (waiting != nullptr) snap_normal(waiting);
            waiting = at;
        }
        if (op != glapi::Op::Vertex3f && op != glapi::Op::Vertex2f) continue;
        std::array<float, 4> values{0, 0, 0, 1};
        std::memcpy(values.data(), at, bytes);
        const __m128 before = _mm_loadu_ps(values.data()), after = grid.snapped(before, reach);
        _mm_storeu_ps(values.data(), after);
        std::memcpy(at, values.data(), bytes);
        ++out.vertices;
        if (measure) out.farthest = std::max(out.farthest, grid.distance(before, after).value_or(0));
    }
    return out;
}

}  // namespace wall::client
