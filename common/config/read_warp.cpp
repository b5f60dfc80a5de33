// SPDX-License-Identifier: MIT
#include "common/config/read_warp.h"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "common/config/parse_toml.h"

namespace wall::config {
namespace {

constexpr double kFarthest = 1e6;              // that a number of a warp may be from 0
constexpr std::uintmax_t kMaxBytes = 4 << 20;  // of a file

void read_mesh(TreeReader& read, const toml::table& mesh, geom::Warp& out) {
    read.only(mesh, "[mesh]", {"columns", "rows", "points"});
    out.columns = static_cast<std::uint32_t>(read.integer(mesh, "columns", 2, geom::kMaxMeshPoints, 0));
    out.rows = static_cast<std::uint32_t>(read.integer(mesh, "rows", 2, geom::kMaxMeshPoints, 0));
    const auto* points = mesh.get("points");
    const auto* array = points ? points->as_array() : nullptr;
    const std::size_t wanted = std::size_t{out.columns} * out.rows;
    if (wanted == 0 || !array || array->size() != wanted) {
        read.refuse(points ? points->source() : mesh.source(),
                    "[mesh]: expected 'columns', 'rows' and 'points', columns times rows of [x, y] or [], row by row");
        return;
    }
    for (const toml::node& point : *array) {
        if (const auto* nothing = point.as_array(); nothing && nothing->empty()) {
            out.points.push_back({NAN, NAN});
            continue;
        }
        const auto xy = read.numbers(point, "'points'", "[x, y], or [] for black", 2, 2, -kFarthest, kFarthest);
        out.points.push_back({xy[0], xy[1]});
    }
}

geom::Warp read_warp(TreeReader& read, const toml::table& root) {
    read.only(root, "a warp", {"homography", "mesh"});
    const auto *homography = root.get("homography"), *mesh = root.get("mesh");
    geom::Warp out;
    if ((homography != nullptr) == (mesh != nullptr)) {
        read.refuse(root.source(), "expected 'homography' or [mesh], one of them");
        return out;
    }
    if (mesh) {
        read_mesh(read, read.section(root, "mesh"), out);
    } else {
        const auto values = read.numbers(*homography, "'homography'", "9 numbers, row by row", out.homography.size(),
                                         out.homography.size(), -kFarthest, kFarthest);
        std::ranges::copy(values, out.homography.begin());
    }
    if (read.error()) return out;
    if (const char* wrong = geom::wrong_with(out))
        read.refuse((mesh ? mesh : homography)->source(),
                    "this warp " + std::string(wrong) + ": expected one that keeps every part of the output apart");
    return out;
}

Result<geom::Warp> load_warp(const std::filesystem::path& path, const std::string& tile) {
    const std::string expected = path.string() + ": cannot be read: expected the warp of tile '" + tile + "'";
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    if (error) return fail(expected + ": " + error.message());
    if (bytes > kMaxBytes) return fail(path.string() + ": expected a warp of at most 4 MiB");
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) return fail(expected);
    return parse_warp(text.view(), path.string());
}

}  // namespace

Result<geom::Warp> parse_warp(std::string_view toml, std::string_view file_name) {
    return parse_toml(toml, file_name, read_warp);
}

Result<void> load_warps(WallConfig& wall, const std::filesystem::path& folder) {
    std::map<std::filesystem::path, std::shared_ptr<const geom::Warp>> warps;  // tiles may share one
    for (const auto& node : wall.nodes) {
        for (const auto& tile : node.tiles) {
            if (tile.warp_file.empty()) continue;
            auto& warp = warps[folder / tile.warp_file];
            if (warp) continue;
            auto loaded = load_warp(folder / tile.warp_file, tile.name);
            if (!loaded) return tl::unexpected(loaded.error());
            warp = std::make_shared<const geom::Warp>(std::move(*loaded));
        }
    }
    for (auto& node : wall.nodes)
        for (auto& tile : node.tiles)
            if (!tile.warp_file.empty()) tile.output.warp = warps[folder / tile.warp_file];
    return {};
}

}  // namespace wall::config
