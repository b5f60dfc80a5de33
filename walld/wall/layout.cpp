// SPDX-License-Identifier: MIT
#include "walld/wall/layout.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "common/json/parse_json.h"
#include "common/wire/limits.h"

namespace wall::walld {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;
constexpr std::size_t kMaxWindows = 4096;
constexpr auto kMaxExtent = static_cast<std::int32_t>(wire::kMaxSurfaceExtent);

/// Bounded, so that sums of its members cannot overflow.
bool rect_ok(const geom::Rect& rect) {
    return rect.width > 0 && rect.height > 0 && rect.width <= kMaxExtent && rect.height <= kMaxExtent &&
           std::abs(std::int64_t{rect.x}) <= kMaxExtent && std::abs(std::int64_t{rect.y}) <= kMaxExtent;
}

json entry_json(const LayoutEntry& entry) {
    return {{"name", entry.window.name},
            {"program", entry.window.program},
            {"title", entry.window.title},
            {"rect", {entry.rect.x, entry.rect.y, entry.rect.width, entry.rect.height}},
            {"scaled", entry.scaled}};
}

/// Throws what nlohmann::json throws.
LayoutEntry entry_of(const json& value, std::size_t z) {
    const auto rect = value.at("rect").get<std::array<std::int32_t, 4>>();
    LayoutEntry entry{{value.at("name"), value.at("program"), value.at("title")},
                      {rect[0], rect[1], rect[2], rect[3]},
                      value.at("scaled"),
                      z};
    if (!rect_ok(entry.rect)) throw std::runtime_error("window " + std::to_string(z) + ": impossible rectangle");
    return entry;
}

Layout layout_of(const json& value) {
    if (value.at("version") != kVersion) throw std::runtime_error("expected version " + std::to_string(kVersion));
    const auto canvas = value.at("canvas").get<std::array<std::int32_t, 2>>();
    if (!rect_ok({0, 0, canvas[0], canvas[1]})) throw std::runtime_error("impossible canvas");
    const auto& windows = value.at("windows");
    if (!windows.is_array() || windows.size() > kMaxWindows)
        throw std::runtime_error("expected 'windows' to be an array of at most " + std::to_string(kMaxWindows));
    Layout layout{canvas[0], canvas[1], {}};
    for (const auto& window : windows) layout.windows.push_back(entry_of(window, layout.windows.size()));
    return layout;
}

std::int32_t scaled(std::int32_t value, std::int32_t from, std::int32_t to) {
    return static_cast<std::int32_t>(std::lround(double{1} * value * to / from));
}

/// Nothing: the entry is not for this window; else the larger the better.
std::optional<int> match(const WindowName& entry, const WindowName& window) {
    if (entry.name != window.name) return std::nullopt;
    if (entry.name.empty() && entry.program != window.program) return std::nullopt;
    return (entry.program == window.program ? 2 : 0) + (entry.title == window.title ? 1 : 0);
}

}  // namespace

json layout_json(const Layout& layout) {
    json out{{"version", kVersion}, {"canvas", {layout.width, layout.height}}, {"windows", json::array()}};
    for (const auto& entry : layout.windows) out["windows"].push_back(entry_json(entry));
    return out;
}

std::string to_text(const Layout& layout) {
    return layout_json(layout).dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<Layout> parse_layout(const std::string& text) {
    const auto parsed = parse_json(text, kFileJson);
    if (!parsed) return fail("not a layout: " + parsed.error().message);
    try {
        return layout_of(*parsed);
    } catch (const std::exception& error) {
        return fail(std::string("not a layout: ") + error.what());
    }
}

Layout scaled_to(Layout layout, std::int32_t width, std::int32_t height) {
    for (auto& entry : layout.windows) {
        auto& rect = entry.rect;
        const auto right = scaled(rect.right(), layout.width, width),
                   bottom = scaled(rect.bottom(), layout.height, height);
        const auto x = scaled(rect.x, layout.width, width), y = scaled(rect.y, layout.height, height);
        rect = {x, y, std::clamp(right - x, 1, kMaxExtent), std::clamp(bottom - y, 1, kMaxExtent)};
    }
    layout.width = width;
    layout.height = height;
    return layout;
}

std::optional<LayoutEntry> take_place(std::vector<LayoutEntry>& places, const WindowName& window) {
    auto best = places.end();
    std::optional<int> best_match;
    for (auto place = places.begin(); place != places.end(); ++place) {
        const auto found = match(place->window, window);
        if (!found || (best_match && *found <= *best_match)) continue;
        best = place;
        best_match = found;
    }
    if (best == places.end()) return std::nullopt;
    const auto taken = *best;
    places.erase(best);
    return taken;
}

Outcome<void> check_place(const geom::Rect& canvas, const geom::Rect& rect) {
    if (!rect_ok(rect))
        return refuse(RefusalKind::invalid, "a place needs a width and a height from 1 to " +
                                                std::to_string(kMaxExtent) + ", at most as far from the corner");
    if (geom::overlaps(canvas, rect)) return {};
    return refuse(RefusalKind::invalid, "that place is off the canvas, which is " + std::to_string(canvas.width) + "x" +
                                            std::to_string(canvas.height) + " pixels");
}

}  // namespace wall::walld
