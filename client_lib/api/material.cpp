// SPDX-License-Identifier: MIT
// glMaterial: state outside of glBegin .. glEnd, geometry inside (OpenGL 1.2.1, 2.13.2).
#include "client_lib/geometry/material.h"

#include <cstring>

#include "client_lib/context/context.h"
#include "client_lib/context/lists.h"

namespace wall::client::api {
namespace {

constexpr float kLargestShininess = 128;

unsigned components_of(GLenum pname) {
    if (pname == GL_SHININESS) return 1;
    return pname == GL_COLOR_INDEXES ? 3 : 4;
}

void pack_material(Context& c, GLenum face, GLenum pname, const glstate::Vec4& value) {
    std::byte* at = c.packer.append_rare(glapi::Op::Material, 24);
    const GLenum words[2] = {face, pname};
    std::memcpy(at, words, sizeof words);
    std::memcpy(at + sizeof words, value.data(), sizeof value);
    c.packer.materials.push_back({face, pname, value});
}

void set_material(Context& c, GLenum face, GLenum pname, const glstate::Vec4& value) {
    if (!c.packer.materials.empty()) c.flush_block();
    if (!changes_material(c.state, face, pname, value)) return;
    c.flush_block();
    assign_material(c.state, face, pname, value);
}

}  // namespace

void Materialfv(Context& c, GLenum face, GLenum pname, const GLfloat* params) {
    const bool both = face == GL_FRONT_AND_BACK || !c.profile.is_es1();  // OpenGL ES 1.1, 2.12.2
    if (!both || !valid_material(face, pname)) return c.error(GL_INVALID_ENUM);
    glstate::Vec4 value{};
    for (unsigned i = 0; i < components_of(pname); ++i) value[i] = params[i];
    if (pname == GL_SHININESS && !(value[0] >= 0 && value[0] <= kLargestShininess)) return c.error(GL_INVALID_VALUE);
    if (c.packer.inside() || c.lists->packing) return pack_material(c, face, pname, value);
    set_material(c, face, pname, value);
}

}  // namespace wall::client::api
