// SPDX-License-Identifier: MIT
#include "common/glstate/view_change.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wall::glstate {
namespace {

using Vec = std::array<double, 3>;
using Mat3 = std::array<Vec, 3>;  ///< rows

constexpr double kLeast = 1e-12;   // of a length, to that of the row
constexpr double kSheared = 1e-3;  // of x by y

double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec scaled(const Vec& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }
Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Mat3 times(const Mat3& a, const Mat3& b) {
    Mat3 out{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 3; ++i) out[r][c] += a[r][i] * b[i][c];
    return out;
}

/// (x, y, w) of directions (right, up, ahead), divided by w's share of `ahead`, and z = depth_by_w * w + depth.
struct Camera {
    double xx, xy, xz, yy, yz;
    double depth_by_w, depth;
};

/// The rows of x, y and w taken apart from below: w grows straight ahead; up is what is left of y's row, and right what
/// is left of x's. So right and up are those of the picture, also where it is mirrored.
std::optional<Camera> camera_of(const Mat4& m) {
    const auto row = [&](std::size_t r) { return Vec{m[r], m[4 + r], m[8 + r]}; };
    const Vec x = row(0), y = row(1), z = row(2), w = row(3);
    const double size = std::sqrt(dot(w, w));
    const double largest = std::sqrt(std::max(dot(x, x), dot(y, y)));
    if (!(size > kLeast * largest) || !std::isfinite(largest)) return std::nullopt;  // parallel
    const Vec ahead = scaled(w, 1 / size);
    const double yz = dot(y, ahead);
    const Vec rest_of_y = minus(y, scaled(ahead, yz));
    const double yy = std::sqrt(dot(rest_of_y, rest_of_y));
    if (!(yy > kLeast * largest)) return std::nullopt;
    const Vec up = scaled(rest_of_y, 1 / yy);
    const double xz = dot(x, ahead), xy = dot(x, up);
    const Vec rest_of_x = minus(minus(x, scaled(ahead, xz)), scaled(up, xy));
    const double xx = std::sqrt(dot(rest_of_x, rest_of_x));
    if (!(xx > kLeast * largest) || std::abs(xy) > kSheared * xx) return std::nullopt;
    const double depth_by_w = dot(z, ahead) / size;
    return Camera{xx / size,
                  xy / size,
                  xz / size,
                  yy / size,
                  yz / size,
                  depth_by_w,
                  static_cast<double>(m[14]) - depth_by_w * static_cast<double>(m[15])};
}

Vec wide(const geom::Vec3& v) { return {v[0], v[1], v[2]}; }

/// (x, y, w) of a view from those of the camera.
Mat3 looking(const geom::View& view, const Camera& c) {
    const double width = static_cast<double>(view.right_edge) - view.left,
                 height = static_cast<double>(view.top) - view.bottom;
    const Mat3 of_view{Vec{2 / width, 0, -(static_cast<double>(view.right_edge) + view.left) / width},
                       Vec{0, 2 / height, -(static_cast<double>(view.top) + view.bottom) / height}, Vec{0, 0, 1}};
    const Mat3 axes{wide(view.right), wide(view.up), wide(view.ahead)};
    // The inverse of K, whose last row is (0, 0, 1).
    const Mat3 back{Vec{1 / c.xx, -c.xy / (c.xx * c.yy), (c.xy * c.yz / c.yy - c.xz) / c.xx},
                    Vec{0, 1 / c.yy, -c.yz / c.yy}, Vec{0, 0, 1}};
    return times(times(of_view, axes), back);
}

}  // namespace

std::optional<ViewChange> view_change(const geom::EyeView& view, const Mat4& camera) {
    const auto c = camera_of(camera);
    if (!c) return std::nullopt;
    const Mat3 h = view.elsewhere ? looking(*view.elsewhere, *c) : Mat3{Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}};
    const double a = c->depth_by_w;
    // Column by column: x, y, z, w.
    ViewChange out{h[0][0], h[1][0], a * h[2][0], h[2][0], h[0][1], h[1][1], a * h[2][1],       h[2][1],
                   0,       0,       1,           0,       h[0][2], h[1][2], a * (h[2][2] - 1), h[2][2]};
    const auto [shift, screen] = view.parallax;
    if (shift == 0 || !(std::abs(c->depth) > kLeast)) return out;  // without a depth there is no 1 in clip coordinates
    constexpr std::size_t kX = 0, kZ = 2, kW = 3;
    const auto at = [&out](std::size_t row, std::size_t column) -> double& { return out[4 * column + row]; };
    for (const std::size_t column : {kX, std::size_t{1}, kW}) at(kX, column) += shift * at(kW, column);
    at(kX, kZ) -= shift * screen / c->depth;
    at(kX, kW) += shift * screen * a / c->depth;
    return out;
}

Mat4 narrow(const ViewChange& change) {
    Mat4 out;
    std::ranges::transform(change, out.begin(), [](double v) { return static_cast<float>(v); });
    return out;
}

Projection seen(const Projection& own, const Mat4& change) {
    Projection out = own;
    out.clip_from_object = multiply(change, own.clip_from_object);
    if (!own.by_shader) return out;
    Mat4 sizes;
    std::ranges::transform(change, sizes.begin(), [](float v) { return std::abs(v); });
    out.sizes = multiply(sizes, own.sizes);
    return out;
}

Mat4 product(const ViewChange& change, const Mat4& camera) {
    Mat4 out;
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t r = 0; r < 4; ++r) {
            double sum = 0;
            for (std::size_t i = 0; i < 4; ++i) sum += change[4 * i + r] * static_cast<double>(camera[4 * c + i]);
            out[4 * c + r] = static_cast<float>(sum);
        }
    return out;
}

}  // namespace wall::glstate
