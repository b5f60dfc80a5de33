// SPDX-License-Identifier: MIT
#include "common/config/read_view.h"

#include <algorithm>
#include <array>
#include <variant>

namespace wall::config {
namespace {

constexpr double kMostTurn = 360;                       // degrees
constexpr double kLeastAngle = 0.01, kMostAngle = 179;  // of a field of view
constexpr double kMostMetres = 10'000;
constexpr std::array<const char*, 4> kAngles{"yaw", "pitch", "roll", "fov"};
constexpr std::string_view kThreeMetres = "[x, y, z] in metres: to the right, up, towards the person";

geom::Vec3 read_place(TreeReader& read, const toml::node& node, const std::string& what) {
    const auto values = read.numbers(node, what, kThreeMetres, 3, 3, -kMostMetres, kMostMetres);
    return {values[0], values[1], values[2]};
}

/// One number: from the left edge to the right one, with pixels as high as they are wide.
std::array<double, 2> read_fov(TreeReader& read, const toml::node& node, const geom::Rect& rect) {
    if (node.is_array()) {
        const auto both =
            read.numbers(node, "'fov'", "an angle in degrees, or [width, height]", 2, 2, kLeastAngle, kMostAngle);
        return {both[0], both[1]};
    }
    const double width = read.number(node, "'fov'", kLeastAngle, kMostAngle);
    return {width, geom::angle_of_ratio(width, static_cast<double>(rect.height) / std::max(rect.width, 1))};
}

std::optional<geom::View> read_angles(TreeReader& read, const toml::table& tile, const geom::Rect& rect) {
    const auto* fov = tile.get("fov");
    if (!fov) {
        const auto* some = std::ranges::find_if(kAngles, [&](const char* key) { return tile.get(key) != nullptr; });
        if (some != kAngles.end())
            read.refuse(tile.get(*some)->source(),
                        TreeReader::quoted(*some) +
                            ": expected 'fov' beside it, the angle from the tile's left edge "
                            "to its right one in degrees, or [width, height]");
        return std::nullopt;
    }
    const auto turned = [&](const char* key) { return read.number(tile, key, -kMostTurn, kMostTurn, 0); };
    const auto [width, height] = read_fov(read, *fov, rect);
    return geom::view_of_angles(turned("yaw"), turned("pitch"), turned("roll"), width, height);
}

std::optional<geom::View> read_screen(TreeReader& read, const toml::table& tile, const geom::Vec3& eye) {
    const auto& screen = read.section(tile, "screen");
    read.only(screen, "'screen'", {"lower_left", "lower_right", "upper_left"});
    const auto corner = [&](const char* key) -> geom::Vec3 {
        if (const auto* node = screen.get(key)) return read_place(read, *node, TreeReader::quoted(key));
        read.refuse(tile.get("screen")->source(),
                    "'screen': '" + std::string(key) + "' is missing: expected " + std::string(kThreeMetres));
        return {};
    };
    const geom::Screen corners{corner("lower_left"), corner("lower_right"), corner("upper_left")};
    if (read.error()) return std::nullopt;
    const auto view = geom::view_of_screen(corners, eye);
    if (const auto* found = std::get_if<geom::View>(&view)) return *found;
    read.refuse(tile.get("screen")->source(),
                "'screen': " + std::string(std::get<const char*>(view)) +
                    ": expected three corners of a rectangle as seen from 'eye' of [wall], in front of it");
    return std::nullopt;
}

}  // namespace

geom::Vec3 read_eye(TreeReader& read, const toml::table& wall) {
    const auto* node = wall.get("eye");
    return node ? read_place(read, *node, "'eye'") : geom::Vec3{};
}

std::optional<geom::View> read_view(TreeReader& read, const toml::table& tile, const geom::Rect& rect,
                                    const geom::Vec3& eye) {
    const auto* screen = tile.get("screen");
    if (!screen) return read_angles(read, tile, rect);
    for (const char* key : kAngles)
        if (const auto* node = tile.get(key))
            read.refuse(node->source(), TreeReader::quoted(key) +
                                            " beside 'screen': expected either where the screen's corners are, or "
                                            "where it looks");
    return read_screen(read, tile, eye);
}

}  // namespace wall::config
