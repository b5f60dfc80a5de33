// SPDX-License-Identifier: MIT
// What vertex attributes and materials a run of geometry leaves behind. The driver keeps them by itself; here only the
// last value of each kind is noted while commands are decoded (a store, no comparison), and folded into a soft context
// and the driver's mirror when the run is over. Render thread.
#pragma once

#include <array>
#include <cstdint>

#include "common/glstate/diff.h"
#include "gen/glstate/state.gen.h"

namespace wall::tileserver {

class AttributeTrail {
public:
    void clear() { seen_ = attribs_seen_ = materials_seen_ = 0; }
    bool empty() const { return (seen_ | attribs_seen_ | materials_seen_) == 0; }

    void color(float r, float g, float b, float a) { seen_ |= kColor, color_ = {r, g, b, a}; }
    void normal(float x, float y, float z) { seen_ |= kNormal, normal_ = {x, y, z}; }
    void secondary_color(float r, float g, float b) { seen_ |= kSecondary, secondary_ = {r, g, b, 1}; }
    void fog_coord(float c) { seen_ |= kFog, fog_ = c; }
    void edge_flag(bool flag) { seen_ |= kEdge, edge_ = flag ? 1 : 0; }
    void color_index(float c) { seen_ |= kIndex, index_ = c; }
    void texcoord(unsigned unit, float s, float t, float r, float q) {
        seen_ |= kTexcoord0 << unit, texcoord_[unit] = {s, t, r, q};
    }
    void vertex_attrib(unsigned i, float x, float y, float z, float w) {
        attribs_seen_ |= 1u << i, attrib_[i] = {x, y, z, w};
    }
    /// False: no such face or parameter.
    bool material(GLenum face, GLenum pname, const glstate::Vec4& value);

    /// As if the commands of `later` had followed.
    void append(const AttributeTrail& later);
    void fold_into(glstate::State& state) const;

private:
    // ambient, diffuse, specular, emission, shininess, indexes
    static constexpr unsigned kMaterials = 6;
    static constexpr std::uint32_t kColor = 1, kNormal = 2, kSecondary = 4, kFog = 8, kEdge = 16, kIndex = 32,
                                   kTexcoord0 = 64;
    void set_material(unsigned face, unsigned parameter, const glstate::Vec4& value) {
        materials_seen_ |= 1u << (face * kMaterials + parameter);
        material_[face][parameter] = value;
    }
    void fold_materials(glstate::State& state) const;

    std::uint32_t seen_ = 0, attribs_seen_ = 0, materials_seen_ = 0;
    glstate::Vec4 color_{}, secondary_{};
    glstate::Vec3 normal_{};
    float fog_ = 0, index_ = 0;
    glstate::Flag edge_ = 0;
    std::array<glstate::Vec4, 8> texcoord_{};
    std::array<glstate::Vec4, 16> attrib_{};
    std::array<std::array<glstate::Vec4, kMaterials>, 2> material_{};
};

}  // namespace wall::tileserver
