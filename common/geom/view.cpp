// SPDX-License-Identifier: MIT
#include "common/geom/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wall::geom {
namespace {

using Wide = std::array<double, 3>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLeastExtent = 1e-6;  // of a screen's sides, in metres, and of what an edge is away from its opposite
constexpr double kRightAngle = 1e-3;   // a cosine that is as good as none
constexpr double kLeastDistance = 1e-3;  // of the eye from the screen's plane, to the screen's size

double dot(const Wide& a, const Wide& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Wide minus(const Wide& a, const Wide& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Wide sum(const Wide& a, double s, const Wide& b, double t) {
    return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}
double length(const Wide& a) { return std::sqrt(dot(a, a)); }
Wide scaled(const Wide& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }
Wide cross(const Wide& a, const Wide& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Wide widen(const Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 narrow(const Wide& v) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}; }

/// From a room, whose z points to the person, to (right, up, ahead).
Vec3 as_direction(const Wide& room) { return narrow({room[0], room[1], -room[2]}); }

}  // namespace

View view_of_angles(double yaw, double pitch, double roll, double width, double height) {
    return view_of_angles(yaw, pitch, roll, -width / 2, width / 2, -height / 2, height / 2);
}

View view_of_angles(double yaw, double pitch, double roll, double left, double right, double down, double up_angle) {
    const double y = yaw * kDegree, p = pitch * kDegree, r = roll * kDegree;
    const Wide level{std::cos(y), 0, -std::sin(y)};
    const Wide upright{-std::sin(y) * std::sin(p), std::cos(p), -std::cos(y) * std::sin(p)};
    View out;
    out.right = narrow(sum(level, std::cos(r), upright, -std::sin(r)));
    out.up = narrow(sum(level, std::sin(r), upright, std::cos(r)));
    out.ahead = narrow({std::sin(y) * std::cos(p), std::sin(p), std::cos(y) * std::cos(p)});
    out.left = static_cast<float>(std::tan(left * kDegree));
    out.right_edge = static_cast<float>(std::tan(right * kDegree));
    out.bottom = static_cast<float>(std::tan(down * kDegree));
    out.top = static_cast<float>(std::tan(up_angle * kDegree));
    return out;
}

double angle_of_ratio(double angle, double ratio) {
    return 2 * std::atan(std::tan(angle * kDegree / 2) * ratio) / kDegree;
}

std::variant<View, const char*> view_of_screen(const Screen& screen, const Vec3& eye) {
    const Wide corner = widen(screen.lower_left);
    const Wide along = minus(widen(screen.lower_right), corner), upwards = minus(widen(screen.upper_left), corner);
    const double width = length(along), height = length(upwards);
    if (width < kLeastExtent || height < kLeastExtent) return "two of the corners are the same";
    const Wide right = scaled(along, 1 / width);
    const double leaning = dot(right, upwards) / height;
    if (std::abs(leaning) > 1 - kRightAngle) return "the three corners lie on one line";
    if (std::abs(leaning) > kRightAngle) return "the corners make no right angle at lower_left";
    const Wide across = sum(upwards, 1, right, -dot(right, upwards));
    const Wide up = scaled(across, 1 / length(across)), to_person = cross(right, up);
    const Wide from_eye = minus(corner, widen(eye));
    const double distance = -dot(from_eye, to_person);
    if (std::abs(distance) < kLeastDistance * std::max(width, height)) return "the eye lies in the screen's plane";
    if (distance < 0) return "the eye is behind the screen";
    View out;
    out.right = as_direction(right);
    out.up = as_direction(up);
    out.ahead = as_direction(scaled(to_person, -1));
    const double left = dot(from_eye, right) / distance, bottom = dot(from_eye, up) / distance;
    out.left = static_cast<float>(left);
    out.right_edge = static_cast<float>(left + width / distance);
    out.bottom = static_cast<float>(bottom);
    out.top = static_cast<float>(bottom + height / distance);
    return out;
}

ViewValues values_of(const View& view) {
    const auto& [right, up, ahead, left, right_edge, bottom, top] = view;
    return {right[0], right[1], right[2], up[0],      up[1],  up[2], ahead[0],
            ahead[1], ahead[2], left,     right_edge, bottom, top};
}

std::optional<View> view_of_values(std::span<const float> values) {
    if (values.size() != ViewValues{}.size()) return std::nullopt;
    const auto axis = [&](std::size_t i) { return Vec3{values[3 * i], values[3 * i + 1], values[3 * i + 2]}; };
    return View{axis(0), axis(1), axis(2), values[9], values[10], values[11], values[12]};
}

const char* wrong_with(const View& view) {
    constexpr double kLargest = 1e6;  // of an edge: nearly 180 degrees
    const std::array<Wide, 3> axes{widen(view.right), widen(view.up), widen(view.ahead)};
    for (std::size_t i = 0; i < axes.size(); ++i)
        for (std::size_t j = i; j < axes.size(); ++j)
            if (!(std::abs(dot(axes[i], axes[j]) - (i == j ? 1 : 0)) < kRightAngle))
                return "axes that are no unit vectors at right angles";
    for (const float edge : {view.left, view.right_edge, view.bottom, view.top})
        if (!(std::abs(edge) < kLargest)) return "an edge that is none";
    if (!(view.right_edge - view.left > kLeastExtent) || !(view.top - view.bottom > kLeastExtent))
        return "edges that leave nothing between them";
    return nullptr;
}

EyeViewValues values_of(const EyeView& view) {
    EyeViewValues out{};
    out[0] = view.elsewhere ? 1 : 0;
    if (view.elsewhere) std::ranges::copy(values_of(*view.elsewhere), out.begin() + 1);
    out[14] = view.parallax.shift;
    out[15] = view.parallax.screen;
    return out;
}

std::variant<EyeView, const char*> eye_view_of_values(const EyeViewValues& values) {
    constexpr float kMostShift = 1;  // half widths: at 1 the two eyes' pictures are a whole one apart
    constexpr float kLeastScreen = 1e-6f, kMostScreen = 1e9f;  // the program's units
    EyeView out{.parallax = {values[14], values[15]}};
    if (!(std::abs(out.parallax.shift) <= kMostShift)) return "eyes that are more than a picture apart";
    if (!(out.parallax.screen >= kLeastScreen && out.parallax.screen <= kMostScreen)) return "a screen at no distance";
    if (values[0] == 0) return out;
    out.elsewhere = view_of_values(std::span(values).subspan<1, ViewValues{}.size()>());
    if (const char* wrong = wrong_with(*out.elsewhere)) return wrong;
    return out;
}

}  // namespace wall::geom
