// SPDX-License-Identifier: MIT
// What vertex attributes and materials a run of geometry leaves behind. The driver keeps them by itself; here only the
// last value of each kind is noted while commands are decoded (a store, no comparison), and folded into a soft context
// and the driver's mirror when the run is over. Render thread.
#pragma once

#include <array>
#include <cstdint>

#include "common/glstate/diff.h"
#include "gen/glstate/attributes.gen.h"
#include "gen/glstate/state.gen.h"

namespace wall::tileserver {

class AttributeTrail {
public:
    void clear() { seen_ = materials_seen_ = 0; }
    bool empty() const { return (seen_ | materials_seen_) == 0; }

    /// A command gave an attribute this value; what it lacks of four components is 0, 0, 1.
    void set(glstate::Attribute attribute, float x, float y = 0, float z = 0, float w = 1) {
        const std::size_t place = glstate::place_of(attribute);
        seen_ |= 1u << place, values_[place] = {x, y, z, w};
    }
    /// False: no such face or parameter.
    bool material(GLenum face, GLenum pname, const glstate::Vec4& value);

    /// As if the commands of `later` had followed.
    void append(const AttributeTrail& later);
    void fold_into(glstate::State& state) const;

private:
    // ambient, diffuse, specular, emission, shininess, indexes
    static constexpr unsigned kMaterials = 6;
    void set_material(unsigned face, unsigned parameter, const glstate::Vec4& value) {
        materials_seen_ |= 1u << (face * kMaterials + parameter);
        material_[face][parameter] = value;
    }
    void fold_materials(glstate::State& state) const;

    static_assert(glstate::kAttributes <= 32 && 2 * kMaterials <= 32);
    std::uint32_t seen_ = 0, materials_seen_ = 0;
    std::array<glstate::Vec4, glstate::kAttributes> values_{};
    std::array<std::array<glstate::Vec4, kMaterials>, 2> material_{};
};

}  // namespace wall::tileserver
