// SPDX-License-Identifier: MIT
#include "tileserver/driver/attribute_trail.h"

#include <bit>

namespace wall::tileserver {
namespace el = glstate::el;
using glstate::assign;

namespace {

template <class Each>
void for_each_bit(std::uint32_t bits, Each&& each) {
    for (; bits != 0; bits &= bits - 1) each(static_cast<unsigned>(std::countr_zero(bits)));
}

}  // namespace

bool AttributeTrail::material(GLenum face, GLenum pname, const glstate::Vec4& value) {
    constexpr std::array<GLenum, kMaterials> kNames = {GL_AMBIENT,  GL_DIFFUSE,   GL_SPECULAR,
                                                       GL_EMISSION, GL_SHININESS, GL_COLOR_INDEXES};
    if (face != GL_FRONT && face != GL_BACK && face != GL_FRONT_AND_BACK) return false;
    bool known = false;
    for (unsigned parameter = 0; parameter < kMaterials; ++parameter) {
        const bool both = pname == GL_AMBIENT_AND_DIFFUSE && parameter < 2;
        if (pname != kNames[parameter] && !both) continue;
        if (face != GL_BACK) set_material(0, parameter, value);
        if (face != GL_FRONT) set_material(1, parameter, value);
        known = true;
    }
    return known;
}

void AttributeTrail::append(const AttributeTrail& later) {
    for_each_bit(later.seen_, [&](unsigned place) { values_[place] = later.values_[place]; });
    for_each_bit(later.materials_seen_, [&](unsigned i) {
        material_[i / kMaterials][i % kMaterials] = later.material_[i / kMaterials][i % kMaterials];
    });
    seen_ |= later.seen_;
    materials_seen_ |= later.materials_seen_;
}

void AttributeTrail::fold_into(glstate::State& state) const {
    for_each_bit(seen_, [&](unsigned place) {
        glstate::with_attribute(static_cast<glstate::Attribute>(place), values_[place],
                                [&]<class E>(E, unsigned i, const auto& value) { assign<E>(state, i, value); });
    });
    if (materials_seen_ != 0) fold_materials(state);
}

void AttributeTrail::fold_materials(glstate::State& state) const {
    for (unsigned face = 0; face < 2; ++face) {
        const auto& m = material_[face];
        const std::uint32_t seen = materials_seen_ >> (face * kMaterials);
        // A parameter that follows the current colour does not take the value in the driver either.
        const auto store = [&]<class E>(E, unsigned parameter) {
            if ((seen >> parameter & 1) != 0 && !glstate::follows_color<E>(state, face))
                assign<E>(state, face, m[parameter]);
        };
        store(el::material_ambient{}, 0);
        store(el::material_diffuse{}, 1);
        store(el::material_specular{}, 2);
        store(el::material_emission{}, 3);
        if (seen >> 4 & 1) assign<el::material_shininess>(state, face, m[4][0]);
        if (seen >> 5 & 1) assign<el::material_indexes>(state, face, {m[5][0], m[5][1], m[5][2]});
    }
}

}  // namespace wall::tileserver
