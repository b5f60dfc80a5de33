// SPDX-License-Identifier: MIT
// MPCDI files, which other programs write: descriptions, maps and archives of both. What is read can be shown by an
// output; what is not is refused with a sentence.
#include "common/base/assert.h"
#include "common/geom/tile_output.h"
#include "walld/mpcdi/archive.h"
#include "walld/mpcdi/tile_maps.h"

namespace {

using namespace wall::mpcdi;

constexpr std::size_t kMostPlaces = 4096;  // that are turned into a mesh here: more only takes longer

void try_map(const Setup& setup, const Region& region, std::string_view bytes) {
    auto field = parse_pfm(bytes, "map");
    if (!field || field->values.size() > kMostPlaces) return;
    const auto look = look_of(region, setup.profile, std::move(*field), {0, 0, 0});
    if (!look) return;
    if (look->view) WALL_ASSERT(wall::geom::wrong_with(*look->view) == nullptr);
    const auto mesh = mesh_of(look->places, 100, 80, 0.05f);
    WALL_ASSERT(mesh.warp.points.size() == std::size_t{mesh.warp.columns} * mesh.warp.rows);
    if (const auto light = light_of(look->places, nullptr, 1, nullptr, 1, 2.2))
        WALL_ASSERT(wall::geom::wrong_with(*light) == nullptr);
}

void try_archive(std::string bytes) {
    const auto archive = Archive::open(std::move(bytes), "x.mpcdi");
    if (!archive) return;
    const auto description = archive->description();
    if (!description) return;
    const auto setup = parse_setup(*description, archive->description_name());
    if (!setup) return;
    for (const auto& region : setup->regions) {
        if (const auto map = archive->content(region.warp, 1 << 20)) try_map(*setup, region, *map);
        for (const auto& light : {region.alpha, region.beta})
            if (light)
                if (const auto picture = archive->content(light->path, 1 << 20))
                    if (const auto factors = parse_png(*picture, "light"))
                        WALL_ASSERT(factors->values.size() ==
                                    std::size_t{factors->width} * factors->height * factors->channels);
    }
}

}  // namespace

/// The first byte says what the rest is: an archive, a description, or a map of one of the profiles.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    switch (data[0] % 4) {
        case 0: try_archive(bytes); break;
        case 1: {
            const auto setup = parse_setup(bytes, "mpcdi.xml");
            if (!setup) WALL_ASSERT(setup.error().message.starts_with("mpcdi.xml:"));
            break;
        }
        case 2: try_map({Profile::media, {}}, {.id = "r"}, bytes); break;
        default: try_map({Profile::surface, {}}, {.id = "r"}, bytes);
    }
    return 0;
}
