// SPDX-License-Identifier: MIT
// Group [map]: a soft context's evaluator maps and pixel maps. Render thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class MapCommands {
public:
    /// `execution` outlives it.
    explicit MapCommands(Execution& execution) : execution_(execution) {}

    void Map1(GLenum target, float u1, float u2, std::int32_t order, std::span<const std::byte> points);
    void Map2(GLenum target, float u1, float u2, std::int32_t uorder, float v1, float v2, std::int32_t vorder,
              std::span<const std::byte> points);
    void PixelMap(GLenum map, std::span<const std::byte> values);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
