// SPDX-License-Identifier: MIT
#include "walld/mpcdi/load_mpcdi.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "common/config/eyes.h"
#include "common/config/read_warp.h"
#include "common/log/log.h"
#include "walld/mpcdi/archive.h"
#include "walld/mpcdi/tile_maps.h"

namespace wall::mpcdi {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;  // of a file
constexpr std::size_t kMostMap = std::size_t{512} << 20;        // of a map in it
constexpr std::size_t kMostLight = std::size_t{32} << 20;       // of all that a node is told at once
constexpr float kClose = 1.0f / 256;  // pixels of the tile that a mesh may be off: one level between black and white
constexpr float kFar = 0.5f;          // that people are told of
constexpr float kProjectorGamma = 2.2f;

struct File {
    Archive archive;
    Setup setup;
};

Result<File> read_file(const std::filesystem::path& path, const std::string& tile) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    if (error)
        return fail(path.string() + ": cannot be read: expected the MPCDI file of tile '" + tile +
                    "': " + error.message());
    if (bytes > kMostBytes) return fail(path.string() + ": expected an MPCDI file of at most 1 GiB");
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    auto archive = Archive::open(std::move(text).str(), path.string());
    if (!archive) return tl::unexpected(archive.error());
    const auto description = archive->description();
    if (!description) return tl::unexpected(description.error());
    const bool alone = archive->description_name() == archive->name();
    auto setup = parse_setup(*description, alone ? path.string() : path.string() + ": " + archive->description_name());
    if (!setup) return tl::unexpected(setup.error());
    return File{std::move(*archive), std::move(*setup)};
}

Result<const Region*> region_for(const File& file, const config::TileConfig& tile) {
    const auto& regions = file.setup.regions;
    const auto named = std::ranges::find(regions, tile.name, &Region::id);
    if (named != regions.end()) return &*named;
    if (regions.size() == 1) return &regions.front();
    std::string ids;
    for (const auto& region : regions) ids += (ids.empty() ? "'" : ", '") + region.id + "'";
    return fail(file.archive.name() + ": has no region '" + tile.name +
                "': expected a tile called as its region is: " + ids);
}

Result<std::optional<Factors>> light_map(const File& file, const std::optional<LightFile>& light) {
    if (!light) return std::optional<Factors>();
    const auto bytes = file.archive.content(light->path, kMostMap);
    if (!bytes) return tl::unexpected(bytes.error());
    auto out = parse_png(*bytes, file.archive.name() + ": '" + light->path + "'");
    if (!out) return tl::unexpected(out.error());
    return std::optional(std::move(*out));
}

float projector_gamma(const config::TileConfig& tile) {
    return tile.output.color ? tile.output.color->gamma : kProjectorGamma;
}

/// Of a region without a map: each pixel shows its own place.
Field plain_field() { return {2, 2, {{0.25f, 0.25f, 0}, {0.75f, 0.25f, 0}, {0.25f, 0.75f, 0}, {0.75f, 0.75f, 0}}}; }

Result<void> apply(const File& file, const geom::Vec3& eye, config::TileConfig& tile) {
    const auto found = region_for(file, tile);
    if (!found) return tl::unexpected(found.error());
    const Region& region = **found;
    const std::string where = file.archive.name() + ": region '" + region.id + "' ";
    const auto profile = file.setup.profile;
    if (region.width != tile.output.width || region.height != tile.output.height)
        return fail(where + "is of a projector of " + std::to_string(region.width) + " x " +
                    std::to_string(region.height) + " pixels, tile '" + tile.name + "' of " +
                    std::to_string(tile.output.width) + " x " + std::to_string(tile.output.height) +
                    ": expected pixels = [" + std::to_string(region.width) + ", " + std::to_string(region.height) +
                    "]");
    if (profile != Profile::media && tile.view)
        return fail(where + "says where tile '" + tile.name + "' looks (profile \"" + name_of(profile) +
                    "\"): expected no 'fov' or 'screen' beside it in wall.toml");
    if (region.warp.empty() && (profile == Profile::surface || profile == Profile::lamps))
        return fail(where + "has no geometryWarpFile: expected one in profile \"" + name_of(profile) + "\"");
    Field map = plain_field();
    if (!region.warp.empty()) {
        const auto bytes = file.archive.content(region.warp, kMostMap);
        if (!bytes) return tl::unexpected(bytes.error());
        auto parsed = parse_pfm(*bytes, file.archive.name() + ": '" + region.warp + "'");
        if (!parsed) return tl::unexpected(parsed.error());
        map = std::move(*parsed);
    }
    auto look = look_of(region, profile, std::move(map), eye);
    if (!look) return fail(file.archive.name() + ": " + look.error().message);
    const auto alpha = light_map(file, region.alpha), beta = light_map(file, region.beta);
    if (!alpha) return tl::unexpected(alpha.error());
    if (!beta) return tl::unexpected(beta.error());
    if (!region.warp.empty()) {
        auto mesh = mesh_of(look->places, tile.rect.width, tile.rect.height, kClose);
        if (const char* wrong = geom::wrong_with(mesh.warp))
            return fail(where + "has a geometryWarpFile that " + wrong +
                        ": expected one that keeps every part of the output apart");
        if (mesh.error > kFar)
            log::warn("mpcdi_coarse file={} region={} off_by_pixels={:.2f}", log::quoted(file.archive.name()),
                      log::quoted(region.id), mesh.error);
        tile.output.warp = std::make_shared<const geom::Warp>(std::move(mesh.warp));
    }
    tile.output.light =
        light_of(look->places, *alpha ? &**alpha : nullptr, region.alpha ? region.alpha->gamma : 1,
                 *beta ? &**beta : nullptr, region.beta ? region.beta->gamma : 1, projector_gamma(tile));
    if (look->view) tile.view = look->view;
    return {};
}

}  // namespace

Result<void> DescribedFiles::load(config::WallConfig& wall, const std::filesystem::path& folder) {
    if (auto warps = config::load_warps(wall, folder); !warps) return warps;
    std::map<std::filesystem::path, File> files;  // tiles share them
    std::map<Key, Said> said;
    for (auto& node : wall.nodes) {
        std::size_t light = 0;
        for (auto& tile : node.tiles) {
            if (tile.mpcdi_file.empty()) continue;
            const auto path = folder / tile.mpcdi_file;
            std::error_code error;
            Key key{path.string(),
                    std::filesystem::last_write_time(path, error),
                    std::filesystem::file_size(path, error),
                    tile.name,
                    tile.rect.width,
                    tile.rect.height,
                    tile.output.width,
                    tile.output.height,
                    wall.eye,
                    projector_gamma(tile),
                    tile.view.has_value()};
            auto known = known_.find(key);
            if (error || known == known_.end()) {
                auto file = files.find(path);
                if (file == files.end()) {
                    auto read = read_file(path, tile.name);
                    if (!read) return tl::unexpected(read.error());
                    file = files.emplace(path, std::move(*read)).first;
                }
                if (auto applied = apply(file->second, wall.eye, tile); !applied) return applied;
                known = known_.insert_or_assign(key, Said{tile.output.warp, tile.output.light, tile.view}).first;
            }
            tile.output.warp = known->second.warp;
            tile.output.light = known->second.light;
            tile.view = known->second.view;
            if (auto* right = config::companion_of(tile, node.tiles)) right->view = tile.view;
            said.insert(*known);
            if (tile.output.light)
                light += tile.output.light->share.values.size() + tile.output.light->lift.values.size();
        }
        if (light > kMostLight)
            return fail(folder.string() + ": the maps of light of node '" + node.name + "' have " +
                        std::to_string(light) +
                        " bytes: expected at most 32 MiB for a node (grey maps, or several nodes)");
    }
    known_ = std::move(said);
    return {};
}

}  // namespace wall::mpcdi
