// SPDX-License-Identifier: MIT
#include "walld/mpcdi/tile_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wall::mpcdi {
namespace {

using Wide = std::array<double, 3>;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr double kLeastAhead = 0.05;                         // of a direction, to its length: 87 degrees aside
constexpr std::uint32_t kLeastCells = 16, kMostCells = 255;  // of a mesh's longer side
constexpr double kFarthest = 1e6;                            // of a place, in fractions of the picture

/// Which no NaN is.
bool is_place(const Field::Value& value) { return std::abs(value[0]) < kFarthest && std::abs(value[1]) < kFarthest; }

double dot(const Wide& a, const Wide& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Wide cross(const Wide& a, const Wide& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Wide unit(const Wide& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}
geom::Vec3 narrow(const Wide& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// From the eye to a place of the map, as (right, up, ahead).
Wide direction(const Field::Value& value, const Region& region, const Wide& eye) {
    const Wide place{value[0] * region.metres, value[1] * region.metres, value[2] * region.metres};
    const auto along = [&](const geom::Vec3& axis) { return dot(place, {axis[0], axis[1], axis[2]}); };
    return {along(region.axes.pitch) - eye[0], -along(region.axes.yaw) - eye[1], along(region.axes.roll) - eye[2]};
}

/// The tile is a picture that the eye sees before it, just large enough for all of the screen.
Result<Look> seen_by_eye(const Region& region, Field map, const geom::Vec3& eye_place) {
    const std::string wrong = "region '" + region.id + "': ";
    const Wide eye{eye_place[0], eye_place[1], -eye_place[2]};
    Wide sum{};
    for (const auto& value : map.values) {
        if (!std::isfinite(value[0] + value[1] + value[2])) continue;
        const Wide to = direction(value, region, eye);
        if (dot(to, to) == 0) return fail(wrong + "its screen goes through the eye: expected another [wall] eye");
        const Wide one = unit(to);
        for (std::size_t i = 0; i < 3; ++i) sum[i] += one[i];
    }
    if (dot(sum, sum) == 0) return fail(wrong + "its geometryWarpFile has no place");
    const Wide ahead = unit(sum), above = std::abs(ahead[1]) > 1 - 1e-6 ? Wide{0, 0, 1} : Wide{0, 1, 0};
    const Wide right = unit(cross(above, ahead)), up = cross(ahead, right);
    double left_edge = INFINITY, right_edge = -INFINITY, bottom = INFINITY, top = -INFINITY;
    for (auto& value : map.values) {
        if (!std::isfinite(value[0] + value[1] + value[2])) {
            value = {kNothing, kNothing, kNothing};
            continue;
        }
        const Wide to = unit(direction(value, region, eye));
        const double distance = dot(to, ahead);
        if (distance < kLeastAhead)
            return fail(wrong + "its screen reaches around the eye: expected less than half a turn a projector");
        const double x = dot(to, right) / distance, y = dot(to, up) / distance;
        left_edge = std::min(left_edge, x);
        right_edge = std::max(right_edge, x);
        bottom = std::min(bottom, y);
        top = std::max(top, y);
        value = {static_cast<float>(x), static_cast<float>(y), 0};
    }
    if (!(right_edge - left_edge > 1e-6 && top - bottom > 1e-6))
        return fail(wrong + "its screen is a line, or a point, from where the eye is");
    for (auto& value : map.values) {
        if (std::isnan(value[0])) continue;
        value = {static_cast<float>((value[0] - left_edge) / (right_edge - left_edge)),
                 static_cast<float>((top - value[1]) / (top - bottom)), 0};
    }
    geom::View view;
    view.right = narrow(right);
    view.up = narrow(up);
    view.ahead = narrow(ahead);
    view.left = static_cast<float>(left_edge);
    view.right_edge = static_cast<float>(right_edge);
    view.bottom = static_cast<float>(bottom);
    view.top = static_cast<float>(top);
    return Look{std::move(map), view};
}

/// Continues what is shown over places that show nothing, `rings` of them, so that cells at its border have corners.
void widen(Field& places, std::uint32_t rings) {
    const auto width = static_cast<std::int64_t>(places.width), height = static_cast<std::int64_t>(places.height);
    const auto valid = [&](std::int64_t x, std::int64_t y) {
        return x >= 0 && y >= 0 && x < width && y < height &&
               !std::isnan(places.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y))[0]);
    };
    const auto get = [&](std::int64_t x, std::int64_t y) {
        return places.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    };
    using Place = std::pair<std::int64_t, std::int64_t>;
    constexpr std::array<Place, 4> kWays{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    std::vector<Place> border;
    const auto add_around = [&](std::int64_t x, std::int64_t y) {
        for (const auto& [dx, dy] : kWays)
            if (x + dx >= 0 && y + dy >= 0 && x + dx < width && y + dy < height && !valid(x + dx, y + dy))
                border.emplace_back(x + dx, y + dy);
    };
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            if (valid(x, y)) add_around(x, y);
    for (std::uint32_t ring = 0; ring < rings && !border.empty(); ++ring) {
        std::ranges::sort(border);
        border.erase(std::unique(border.begin(), border.end()), border.end());
        std::vector<std::pair<Place, Field::Value>> found;
        for (const auto& [x, y] : border) {
            float sum_x = 0, sum_y = 0, straight = 0, near_x = 0, near_y = 0, near = 0;
            for (const auto& [dx, dy] : kWays) {
                if (!valid(x + dx, y + dy)) continue;
                const auto first = get(x + dx, y + dy);
                near_x += first[0], near_y += first[1], ++near;
                if (!valid(x + 2 * dx, y + 2 * dy)) continue;
                const auto second = get(x + 2 * dx, y + 2 * dy);
                sum_x += 2 * first[0] - second[0], sum_y += 2 * first[1] - second[1], ++straight;
            }
            if (straight > 0) found.push_back({{x, y}, {sum_x / straight, sum_y / straight, 0}});
            else if (near > 0) found.push_back({{x, y}, {near_x / near, near_y / near, 0}});
        }
        border.clear();
        for (const auto& [place, value] : found)
            places.at(static_cast<std::uint32_t>(place.first), static_cast<std::uint32_t>(place.second)) = value;
        for (const auto& [place, value] : found) add_around(place.first, place.second);
    }
}

/// Linearly between the middles of places, and on beyond the outermost.
geom::Point between(const Field& places, double x, double y) {
    const auto cell = [](double at, std::uint32_t count) {
        const double along = at * count - 0.5, first = std::clamp(std::floor(along), 0.0, count - 2.0);
        return std::pair(static_cast<std::uint32_t>(first), static_cast<float>(along - first));
    };
    const auto [column, s] = cell(x, places.width);
    const auto [row, t] = cell(y, places.height);
    const auto mix = [](const Field::Value& a, const Field::Value& b, float by) {
        return Field::Value{a[0] + (b[0] - a[0]) * by, a[1] + (b[1] - a[1]) * by, 0};
    };
    const auto top = mix(places.at(column, row), places.at(column + 1, row), s);
    const auto bottom = mix(places.at(column, row + 1), places.at(column + 1, row + 1), s);
    const auto out = mix(top, bottom, t);
    return std::isnan(out[0]) || std::isnan(out[1]) ? geom::Point{kNothing, kNothing} : geom::Point{out[0], out[1]};
}

geom::Warp grid_of(const Field& places, std::uint32_t columns, std::uint32_t rows) {
    geom::Warp out;
    out.columns = columns;
    out.rows = rows;
    out.points.reserve(std::size_t{columns} * rows);
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column)
            out.points.push_back(between(places, double{1} * column / (columns - 1), double{1} * row / (rows - 1)));
    return out;
}

/// Of the farthest place that is shown, or of the first that is farther than `enough`; infinity where the mesh shows
/// nothing of it.
float error_of(const Field& places, const geom::TileOutput& by, std::int32_t width, std::int32_t height, float enough) {
    float out = 0;
    for (std::uint32_t y = 0; y < places.height; ++y)
        for (std::uint32_t x = 0; x < places.width; ++x) {
            const auto& wanted = places.at(x, y);
            if (std::isnan(wanted[0])) continue;
            const auto got =
                geom::place_in_tile(by, {(static_cast<float>(x) + 0.5f) / static_cast<float>(places.width),
                                         (static_cast<float>(y) + 0.5f) / static_cast<float>(places.height)});
            const float off = std::max(std::abs(got.x - wanted[0]) * static_cast<float>(width),
                                       std::abs(got.y - wanted[1]) * static_cast<float>(height));
            out = std::max(out, std::isnan(off) ? INFINITY : off);
            if (out > enough) return out;
        }
    return out;
}

std::uint8_t byte_of(double value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255)); }

geom::LightMap::Map map_of(const Factors* factors, double gamma, double projector) {
    if (factors == nullptr) return {};
    geom::LightMap::Map out{factors->width, factors->height, factors->channels, {}};
    out.values.reserve(factors->values.size());
    for (const float value : factors->values) out.values.push_back(byte_of(std::pow(value, gamma / projector)));
    return out;
}

}  // namespace

Result<Look> look_of(const Region& region, Profile profile, Field map, const geom::Vec3& eye) {
    if (profile == Profile::surface || profile == Profile::lamps) return seen_by_eye(region, std::move(map), eye);
    for (auto& value : map.values)
        if (!is_place(value)) value = {kNothing, kNothing, kNothing};
    std::optional<geom::View> view;
    if (region.frustum) {
        const auto& f = *region.frustum;
        view = geom::view_of_angles(f.yaw, f.pitch, f.roll, f.left, f.right, f.down, f.up);
    }
    return Look{std::move(map), view};
}

Mesh mesh_of(const Field& places, std::int32_t width, std::int32_t height, float most) {
    const auto longer = std::max(places.width, places.height);
    Mesh out;
    for (std::uint32_t cells = kLeastCells;; cells = std::min(2 * cells, kMostCells)) {
        Field filled = places;
        widen(filled, 2 * (longer / cells + 2));  // to the corners of a cell, along both of its sides
        const auto along = [&](std::uint32_t extent) {
            const auto wanted = (std::uint64_t{cells} * extent + longer - 1) / longer;
            return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(wanted, 1, extent - 1)) + 1;
        };
        geom::TileOutput by;
        by.warp = std::make_shared<const geom::Warp>(grid_of(filled, along(places.width), along(places.height)));
        const bool last = cells == kMostCells;
        out = {*by.warp, error_of(places, by, width, height, last ? INFINITY : most)};
        if (last || out.error <= most) return out;
    }
}

std::shared_ptr<const geom::LightMap> light_of(const Field& places, const Factors* alpha, double alpha_gamma,
                                               const Factors* beta, double beta_gamma, double gamma) {
    geom::LightMap out{map_of(alpha, alpha_gamma, gamma), map_of(beta, beta_gamma, gamma)};
    const auto nothing = [](const Field::Value& value) { return std::isnan(value[0]); };
    if (std::ranges::any_of(places.values, nothing)) {
        auto& share = out.share;
        if (alpha == nullptr)
            share = {places.width, places.height, 1,
                     std::vector<std::uint8_t>(std::size_t{places.width} * places.height, 255)};
        for (std::uint32_t y = 0; y < share.height; ++y)
            for (std::uint32_t x = 0; x < share.width; ++x) {
                const auto column = std::uint64_t{x} * places.width / share.width;
                const auto row = std::uint64_t{y} * places.height / share.height;
                if (!nothing(places.at(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row)))) continue;
                std::fill_n(&share.values[(std::size_t{y} * share.width + x) * share.channels], share.channels, 0);
            }
    }
    if (out.share.width == 0 && out.lift.width == 0) return nullptr;
    return std::make_shared<const geom::LightMap>(std::move(out));
}

}  // namespace wall::mpcdi
