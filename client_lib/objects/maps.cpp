// SPDX-License-Identifier: MIT
#include "client_lib/objects/maps.h"

#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

// In the order of the enumerants: color 4, index, normal, texture coordinates 1 to 4, vertex 3, vertex 4.
constexpr std::array<unsigned, kEvaluatorMaps> kComponents = {4, 1, 3, 1, 2, 3, 4, 3, 4};
constexpr std::array<std::array<float, 4>, kEvaluatorMaps> kFirstPoint = {{
    {1, 1, 1, 1},
    {1},
    {0, 0, 1},
    {0},
    {0, 0},
    {0, 0, 0},
    {0, 0, 0, 1},
    {0, 0, 0},
    {0, 0, 0, 1},
}};

std::span<const std::byte> bytes_of(const std::vector<float>& values) { return std::as_bytes(std::span(values)); }

}  // namespace

unsigned evaluator_components(unsigned map) { return kComponents[map]; }

void EvaluatorMap::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>&) const {
    if (target < GL_MAP2_COLOR_4) glapi::pack::Map1(buffer, target, u1, u2, u_order, bytes_of(points));
    else glapi::pack::Map2(buffer, target, u1, u2, u_order, v1, v2, v_order, bytes_of(points));
}

void PixelMap::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>&) const {
    glapi::pack::PixelMap(buffer, map, bytes_of(*values));
}

ContextMaps::ContextMaps() {
    for (unsigned i = 0; i < kEvaluatorMaps; ++i) {
        map1[i].target = GL_MAP1_COLOR_4 + i;
        map2[i].target = GL_MAP2_COLOR_4 + i;
        for (EvaluatorMap* map : {&map1[i], &map2[i]})
            map->points.assign(kFirstPoint[i].begin(), kFirstPoint[i].begin() + kComponents[i]);
    }
    for (unsigned i = 0; i < PixelMapTables::kMaps; ++i) {
        pixel_maps[i].map = GL_PIXEL_MAP_I_TO_I + i;
        pixel_maps[i].values = &pixel.tables[i];
    }
}

}  // namespace wall::client
