// SPDX-License-Identifier: MIT
// What the scissor box leaves of commands that would touch all pixels. Pure.
#pragma once

#include <optional>

#include "common/geom/pixel_rect.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// In window pixels; nothing: there is no limit.
inline std::optional<geom::PixelRect> scissor_box(const glstate::State& state) {
    if ((state.window.scissor_enabled & 1) == 0) return std::nullopt;
    const auto& box = state.window.scissor;
    return geom::PixelRect{static_cast<float>(box.x), static_cast<float>(box.y), static_cast<float>(box.x + box.width),
                           static_cast<float>(box.y + box.height)};
}

}  // namespace wall::client
