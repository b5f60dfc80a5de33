// SPDX-License-Identifier: MIT
#include "client_lib/context/maps.h"

#include "client_lib/follow/session.h"
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

bool needs(Node& node, ClientName id, std::uint64_t stamp) {
    if (stamp == 0) return false;
    auto& known = node.object_stamps[id];
    if (known == stamp) return false;
    known = stamp;
    return true;
}

std::span<const std::byte> bytes_of(const std::vector<float>& values) { return std::as_bytes(std::span(values)); }

}  // namespace

unsigned evaluator_components(unsigned map) { return kComponents[map]; }

ContextMaps::ContextMaps() {
    for (unsigned i = 0; i < kEvaluatorMaps; ++i)
        for (EvaluatorMap* map : {&map1[i], &map2[i]}) {
            map->id = next_object_id();
            map->points.assign(kFirstPoint[i].begin(), kFirstPoint[i].begin() + kComponents[i]);
        }
    for (auto& id : pixel_ids) id = next_object_id();
}

void ContextMaps::bring_up_to_date(Node& node, wire::PackBuffer& buffer) const {
    for (unsigned i = 0; i < kEvaluatorMaps; ++i) {
        const EvaluatorMap &a = map1[i], &b = map2[i];
        if (needs(node, a.id, a.stamp))
            glapi::pack::Map1(buffer, GL_MAP1_COLOR_4 + i, a.u1, a.u2, a.u_order, bytes_of(a.points));
        if (needs(node, b.id, b.stamp))
            glapi::pack::Map2(buffer, GL_MAP2_COLOR_4 + i, b.u1, b.u2, b.u_order, b.v1, b.v2, b.v_order,
                              bytes_of(b.points));
    }
    for (unsigned i = 0; i < PixelMapTables::kMaps; ++i)
        if (needs(node, pixel_ids[i], pixel_stamps[i]))
            glapi::pack::PixelMap(buffer, GL_PIXEL_MAP_I_TO_I + i, bytes_of(pixel.tables[i]));
}

}  // namespace wall::client
