// SPDX-License-Identifier: MIT
// What assembly programs take out of a context's state when they place vertices. Pure.
#pragma once

#include <bit>

#include "common/glapi/assembly_format.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {

/// The position has the context's environment parameters of vertices from now on.
inline void set_environment(glapi::LinkedPosition& position, const State& state) {
    for (const std::uint32_t location : position.locations()) {
        const std::uint32_t index = location - glapi::kEnvLocations;
        if (location < glapi::kEnvLocations || index >= el::vertex_env::count) continue;
        const auto words = std::bit_cast<std::array<std::uint32_t, 4>>(el::vertex_env::ref(state, index));
        position.set(location, words.size(), words);
    }
}

}  // namespace wall::glstate
