// SPDX-License-Identifier: MIT
#include "tileserver/render/attribute_trail.h"

namespace wall::tileserver {
namespace el = glstate::el;
using glstate::assign;

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
    if (later.seen_ & kColor) color_ = later.color_;
    if (later.seen_ & kNormal) normal_ = later.normal_;
    if (later.seen_ & kSecondary) secondary_ = later.secondary_;
    if (later.seen_ & kFog) fog_ = later.fog_;
    if (later.seen_ & kEdge) edge_ = later.edge_;
    if (later.seen_ & kIndex) index_ = later.index_;
    for (unsigned i = 0; i < texcoord_.size(); ++i)
        if (later.seen_ & kTexcoord0 << i) texcoord_[i] = later.texcoord_[i];
    for (unsigned i = 0; i < attrib_.size(); ++i)
        if (later.attribs_seen_ >> i & 1) attrib_[i] = later.attrib_[i];
    for (unsigned i = 0; i < 2 * kMaterials; ++i)
        if (later.materials_seen_ >> i & 1)
            material_[i / kMaterials][i % kMaterials] = later.material_[i / kMaterials][i % kMaterials];
    seen_ |= later.seen_;
    attribs_seen_ |= later.attribs_seen_;
    materials_seen_ |= later.materials_seen_;
}

void AttributeTrail::fold_into(glstate::State& state) const {
    if (seen_ & kColor) assign<el::color>(state, 0, color_);
    if (seen_ & kNormal) assign<el::normal>(state, 0, normal_);
    if (seen_ & kSecondary) assign<el::secondary_color>(state, 0, secondary_);
    if (seen_ & kFog) assign<el::fog_coord>(state, 0, fog_);
    if (seen_ & kEdge) assign<el::edge_flag>(state, 0, edge_);
    if (seen_ & kIndex) assign<el::color_index>(state, 0, index_);
    for (unsigned i = 0; i < texcoord_.size(); ++i)
        if (seen_ & kTexcoord0 << i) assign<el::texcoord>(state, i, texcoord_[i]);
    for (unsigned i = 0; attribs_seen_ >> i != 0; ++i)
        if (attribs_seen_ >> i & 1) assign<el::vertex_attrib>(state, i, attrib_[i]);
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
