// SPDX-License-Identifier: MIT
#include "tileserver/execute/map_commands.h"

#include <cstring>
#include <vector>

namespace wall::tileserver {
namespace {

std::vector<float> floats(std::span<const std::byte> bytes) {
    std::vector<float> out(bytes.size() / sizeof(float));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(float));
    return out;
}

}  // namespace

void MapCommands::Map1(GLenum target, float u1, float u2, std::int32_t order, std::span<const std::byte> points) {
    const std::size_t i = evaluator_index(target, false);
    if (i >= kEvaluatorMaps || order < 1 || order > kMaxEvalOrder || u1 == u2) return execution_.refuse("no such map");
    if (points.size() != sizeof(float) * evaluator_components(i) * static_cast<std::size_t>(order))
        return execution_.refuse("points do not fit the order");
    execution_.context->maps.map1[i] = {glstate::next_value_id(), u1, u2, 0, 1, order, 1, floats(points)};
    execution_.context->maps.any_evaluator = true;
}

void MapCommands::Map2(GLenum target, float u1, float u2, std::int32_t uorder, float v1, float v2, std::int32_t vorder,
                       std::span<const std::byte> points) {
    const std::size_t i = evaluator_index(target, true);
    if (i >= kEvaluatorMaps || uorder < 1 || uorder > kMaxEvalOrder || vorder < 1 || vorder > kMaxEvalOrder ||
        u1 == u2 || v1 == v2)
        return execution_.refuse("no such map");
    if (points.size() !=
        sizeof(float) * evaluator_components(i) * static_cast<std::size_t>(uorder) * static_cast<std::size_t>(vorder))
        return execution_.refuse("points do not fit the orders");
    execution_.context->maps.map2[i] = {glstate::next_value_id(), u1, u2, v1, v2, uorder, vorder, floats(points)};
    execution_.context->maps.any_evaluator = true;
}

void MapCommands::PixelMap(GLenum map, std::span<const std::byte> values) {
    const std::size_t i = pixel_map_index(map);
    if (i >= kPixelMaps || values.empty() || values.size() % sizeof(float) != 0 ||
        values.size() / sizeof(float) > kMaxPixelMapTable)
        return execution_.refuse("no such map");
    execution_.context->maps.pixel[i] = {glstate::next_value_id(), floats(values)};
    execution_.context->maps.any_pixel = true;
}

}  // namespace wall::tileserver
