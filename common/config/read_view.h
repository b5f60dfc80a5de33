// SPDX-License-Identifier: MIT
// The keys of wall.toml that say where a tile looks (docs/walls.md, "Views"). Any thread.
#pragma once

#include <optional>

#include "common/config/tree_reader.h"
#include "common/geom/view.h"

namespace wall::config {

/// `eye` of [wall]; absent: the room's origin.
geom::Vec3 read_eye(TreeReader& read, const toml::table& wall);
/// yaw, pitch, roll and fov, or screen, of one [[node.tile]] with this rect; nothing: it has none of them.
std::optional<geom::View> read_view(TreeReader& read, const toml::table& tile, const geom::Rect& rect,
                                    const geom::Vec3& eye);

}  // namespace wall::config
