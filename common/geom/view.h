// SPDX-License-Identifier: MIT
// Where a tile's screen stands around the person in front of it, if it does not lie in one plane with the others: what
// a program shows there is drawn as seen through it, not as a part of the program's one picture (docs/walls.md,
// "Views"). OCTAVIS (paper O, section 2) has eight of them in a ring. Pure.
//
// Directions are (right, up, ahead) as the program's camera looks: (0, 0, 1) is the middle of its picture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

namespace wall::geom {

using Vec3 = std::array<float, 3>;

/// A screen as a window in front of the eye.
struct View {
    Vec3 right{1, 0, 0}, up{0, 1, 0}, ahead{0, 0, 1};  ///< its own axes: unit vectors at right angles
    /// Of its edges, at distance 1 along `ahead`: how far to the right and up.
    float left = -1, right_edge = 1, bottom = -1, top = 1;
    bool operator==(const View&) const = default;
};

/// Degrees: turned to the right, then up, then clockwise as seen; `width` and `height` are the angles from edge to
/// edge, more than 0 and less than 180.
View view_of_angles(double yaw, double pitch, double roll, double width, double height);
/// The same of the angles of each edge from the middle, to the right and up.
View view_of_angles(double yaw, double pitch, double roll, double left, double right, double down, double up);
/// The angle from edge to edge of something `ratio` times as large as what has `angle`, in the same plane; degrees.
double angle_of_ratio(double angle, double ratio);

/// Three corners of a screen, metres: x to the right, y up, z towards the person.
struct Screen {
    Vec3 lower_left{}, lower_right{}, upper_left{};
    bool operator==(const Screen&) const = default;
};
/// As the eye sees it (Kooima, "Generalized Perspective Projection", 2009), or what is wrong with it.
std::variant<View, const char*> view_of_screen(const Screen& screen, const Vec3& eye);

/// As it travels: right, up, ahead, then the left, right, bottom and top edge.
using ViewValues = std::array<float, 13>;
ViewValues values_of(const View& view);
/// Nothing: not as many.
std::optional<View> view_of_values(std::span<const float> values);
/// What is wrong with one that comes from elsewhere; nullptr: nothing.
const char* wrong_with(const View& view);

/// Whose picture a tile shows (docs/walls.md, "Stereo").
enum class Eye : std::uint8_t { both, left, right };

/// An eye beside the program's, as far as one sees it in the picture: what is at distance w from it lies
/// shift * (1 - screen / w) half widths of the picture farther to the right.
struct Parallax {
    float shift = 0;   ///< of what is infinitely far; 0: the program's own eye
    float screen = 1;  ///< the distance, in the program's units, at which nothing is shifted
    bool operator==(const Parallax&) const = default;
};

/// How a tile shows a scene that it does not show as the program draws it.
struct EyeView {
    std::optional<View> elsewhere{};  ///< none: where the program's own camera looks
    Parallax parallax{};              ///< of that picture
    bool operator==(const EyeView&) const = default;
};

/// As it travels: whether it looks elsewhere (1 or 0), where (0s if not), then its parallax.
using EyeViewValues = std::array<float, 16>;
EyeViewValues values_of(const EyeView& view);
/// With what is wrong with it, where something is.
std::variant<EyeView, const char*> eye_view_of_values(const EyeViewValues& values);

}  // namespace wall::geom
