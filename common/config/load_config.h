// SPDX-License-Identifier: MIT
// Reading wall.toml. The error is one line, `FILE:LINE: what is wrong: what was expected`. Any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/config/wall_config.h"

namespace wall::config {

Result<WallConfig> load_config(const std::string& path);
/// Only [[node]] tables, as they may be added to a description with this eye.
Result<std::vector<NodeConfig>> parse_nodes(std::string_view toml, std::string_view file_name,
                                            const geom::Vec3& eye = {});
/// `file_name` is for the error only.
Result<WallConfig> parse_config(std::string_view toml, std::string_view file_name);

}  // namespace wall::config
