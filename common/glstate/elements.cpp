// SPDX-License-Identifier: MIT
#include "common/glstate/elements.h"

#include <cstring>

#include "common/glstate/diff.h"

namespace wall::glstate {

bool apply(State& state, std::uint32_t id, std::span<const std::byte> value) {
    if (value.empty() || element_bytes(id) != value.size()) return false;
    auto* at = reinterpret_cast<std::byte*>(&state) + element_offset(id);
    if (std::memcmp(at, value.data(), value.size()) == 0) return true;
    if (id == el::color_material::id || id == el::color_material_enabled::id) adopt_current_color(state);
    std::memcpy(at, value.data(), value.size());
    state.ids.renew(static_cast<std::size_t>(element_info(id).category));
    return true;
}

}  // namespace wall::glstate
