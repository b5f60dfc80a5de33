// SPDX-License-Identifier: MIT
// The files that wall.toml names besides itself: warps, and MPCDI files for tiles with `mpcdi`. Reads files. One
// thread.
#pragma once

#include <filesystem>

#include "common/config/wall_config.h"

namespace wall::mpcdi {

/// Gives the tiles what they say. Relative names are to `folder`. The error names the file and what was expected.
Result<void> load_files(config::WallConfig& wall, const std::filesystem::path& folder);

}  // namespace wall::mpcdi
