// SPDX-License-Identifier: MIT
#include "walld/streams/stream_scope.h"

#include <algorithm>

namespace wall::walld {
namespace {

std::string size_text(const geom::Rect& rect) { return std::to_string(rect.width) + "x" + std::to_string(rect.height); }

/// What is wanted of the whole, on the canvas.
Result<geom::Rect> region_of(const geom::Rect& whole, const std::optional<geom::Rect>& region) {
    if (!region) return whole;
    if (region->right() > whole.width || region->bottom() > whole.height)
        return fail(".region: expected a part of " + size_text(whole) + " pixels");
    return geom::Rect{whole.x + region->x, whole.y + region->y, region->width, region->height};
}

/// Where a tile lies, or all of what its output shows.
geom::Rect place_of(const config::TileConfig& tile, bool output) {
    return output ? geom::Rect{0, 0, tile.output.width, tile.output.height} : tile.rect;
}

Result<geom::Rect> rect_of(const Wall& wall, const WatchRequest& request, StreamScope& scope) {
    if (request.wall) return region_of(wall.config().canvas(), request.region);
    if (request.follows()) {
        const auto key = wall.resolve({request.session, request.surface});
        if (!key) return fail((request.surface ? ".surface: " : ".session: ") + key.error().message);
        scope.surface = key->surface;
        return wall.find(*key)->place.shown();
    }
    for (const NodeIndex node : wall.nodes().ids()) {
        for (const auto& tile : wall.nodes()[node].config->tiles) {
            scope.tile = {node, tile.slot};
            if (tile.name == request.tile && !tile.arriving)
                return region_of(place_of(tile, request.output), request.region);
        }
    }
    return fail(".tile: there is no tile '" + request.tile + "'");
}

/// The picture's size; it is never larger than what it shows.
void set_size(StreamScope& scope, const WatchRequest& request) {
    const auto fitting = [](std::uint32_t wanted, std::int32_t most) {
        return wanted == 0 ? static_cast<std::uint32_t>(most) : std::min(wanted, static_cast<std::uint32_t>(most));
    };
    scope.width = fitting(request.width, scope.rect.width);
    scope.height = fitting(request.height, scope.rect.height);
    if (!request.fit) return;
    const std::uint64_t full_width = static_cast<std::uint32_t>(scope.rect.width),
                        full_height = static_cast<std::uint32_t>(scope.rect.height);
    const bool wide = scope.width * full_height <= scope.height * full_width;  // the width is what limits it
    const auto rounded = [](std::uint64_t part, std::uint64_t whole) {
        return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, (2 * part + whole) / (2 * whole)));
    };
    if (wide) scope.height = rounded(scope.width * full_height, full_width);
    else scope.width = rounded(scope.height * full_width, full_height);
}

/// A pixel edge at that distance from the scope's, in a picture of `size` pixels of `whole`.
std::int32_t edge(std::int64_t distance, std::int64_t size, std::int64_t whole) {
    return static_cast<std::int32_t>((2 * distance * size + whole) / (2 * whole));
}

geom::Rect in_picture(const StreamScope& scope, const geom::Rect& rect) {
    const auto left = edge(rect.x - scope.rect.x, scope.width, scope.rect.width),
               top = edge(rect.y - scope.rect.y, scope.height, scope.rect.height);
    const auto right = edge(rect.right() - scope.rect.x, scope.width, scope.rect.width),
               bottom = edge(rect.bottom() - scope.rect.y, scope.height, scope.rect.height);
    return {left, top, right - left, bottom - top};
}

}  // namespace

Result<StreamScope> scope_of(const Wall& wall, const WatchRequest& request) {
    StreamScope scope;
    scope.session = request.session;
    scope.surface = request.surface;
    scope.output = request.output;
    const auto rect = rect_of(wall, request, scope);
    if (!rect) return tl::unexpected(rect.error());
    if (rect->empty()) return fail(".session: its window has no pixels");
    scope.rect = *rect;
    set_size(scope, request);
    return scope;
}

std::vector<StreamPart> parts_of(const Wall& wall, const StreamScope& scope) {
    std::vector<StreamPart> out;
    for (const NodeIndex node : wall.nodes().ids()) {
        for (const auto& tile : wall.nodes()[node].config->tiles) {
            const bool asked_for = scope.tile == std::pair(node, tile.slot);
            if (tile.arriving || (scope.tile ? !asked_for : tile.eye == geom::Eye::right)) continue;
            const auto place = place_of(tile, scope.output);
            const auto common = geom::intersect(place, scope.rect);
            const auto at = in_picture(scope, common);
            if (common.empty() || at.empty()) continue;
            out.push_back({node, tile.slot, {common.x - place.x, common.y - place.y, common.width, common.height}, at});
        }
    }
    return out;
}

}  // namespace wall::walld
