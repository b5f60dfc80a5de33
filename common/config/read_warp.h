// SPDX-License-Identifier: MIT
// Files that say how an output is warped (`warp` of a [[node.tile]]; docs/walls.md). Any thread.
#pragma once

#include <filesystem>
#include <string_view>

#include "common/base/result.h"
#include "common/config/wall_config.h"

namespace wall::config {

/// `file_name` is for the error only, `FILE:LINE: what is wrong: what was expected`.
Result<geom::Warp> parse_warp(std::string_view toml, std::string_view file_name);

/// Reads what the tiles' `warp` names, beginning at wall.toml's folder. On an error nothing is changed.
Result<void> load_warps(WallConfig& wall, const std::filesystem::path& folder);

}  // namespace wall::config
