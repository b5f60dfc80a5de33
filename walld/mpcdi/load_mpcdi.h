// SPDX-License-Identifier: MIT
// The files that wall.toml names besides itself: warps, and MPCDI files for tiles with `mpcdi`. Reads files. One
// thread.
#pragma once

#include <compare>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/config/wall_config.h"

namespace wall::mpcdi {

class DescribedFiles {
public:
    /// Gives the tiles what their files say. Relative names are to `folder`. The error names the file and what was
    /// expected. What was read before is read again only if it has changed: a map of a large projector takes a while.
    Result<void> load(config::WallConfig& wall, const std::filesystem::path& folder);

private:
    /// All that it depends on.
    struct Key {
        std::string path;
        std::filesystem::file_time_type written;
        std::uintmax_t bytes = 0;
        std::string tile;
        std::int32_t width = 0, height = 0, output_width = 0, output_height = 0;
        geom::Vec3 eye{};
        float gamma = 0;
        bool looks = false;  ///< wall.toml says where
        auto operator<=>(const Key&) const = default;
    };
    struct Said {
        std::shared_ptr<const geom::Warp> warp;
        std::shared_ptr<const geom::LightMap> light;
        std::optional<geom::View> view;
    };
    std::map<Key, Said> known_;
};

}  // namespace wall::mpcdi
