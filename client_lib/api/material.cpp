// SPDX-License-Identifier: MIT
// glMaterial: state outside of glBegin .. glEnd, geometry inside (OpenGL 1.2.1, 2.13.2).
#include "client_lib/material.h"

#include <cstring>

#include "client_lib/context.h"
#include "client_lib/lists.h"
#include "common/glstate/queries.h"
#include "common/glstate/queries.h"

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
    c.pending_materials.push_back({face, pname, value});
}

void set_material(Context& c, GLenum face, GLenum pname, const glstate::Vec4& value) {
    if (!c.pending_materials.empty()) c.flush_block();
    if (!changes_material(c.state, face, pname, value)) return;
    c.flush_block();
    assign_material(c.state, face, pname, value);
}

template <class Out>
void get_material(Context& c, GLenum face, GLenum pname, Out* out) {
    const auto* entry = glstate::find_param(glstate::ParamFamily::Material, 0, pname);
    if (!entry || (face != GL_FRONT && face != GL_BACK)) return c.error(GL_INVALID_ENUM);
    c.flush_block();  // what is packed comes into the state
    glstate::settle_color_material(c.state);
    glstate::read_components(c.state, entry->id + (face == GL_BACK), 0, entry->kind, entry->components, out);
}

}  // namespace

void Materialfv(Context& c, GLenum face, GLenum pname, const GLfloat* params) {
    if (!valid_material(face, pname)) return c.error(GL_INVALID_ENUM);
    glstate::Vec4 value{};
    for (unsigned i = 0; i < components_of(pname); ++i) value[i] = params[i];
    if (pname == GL_SHININESS && !(value[0] >= 0 && value[0] <= kLargestShininess)) return c.error(GL_INVALID_VALUE);
    if (c.packer.inside() || c.lists->packing) return pack_material(c, face, pname, value);
    set_material(c, face, pname, value);
}

template <class Out>
static void get_material(Context& c, GLenum face, GLenum pname, Out* out) {
    const auto* entry = glstate::find_param(glstate::ParamFamily::Material, 0, pname);
    if (!entry || (face != GL_FRONT && face != GL_BACK)) return c.error(GL_INVALID_ENUM);
    c.flush_block();  // what is packed comes into the state
    glstate::settle_color_material(c.state);
    glstate::read_components(c.state, entry->id + (face == GL_BACK), 0, entry->kind, entry->components, out);
}
void GetMaterialfv(Context& c, GLenum face, GLenum pname, GLfloat* params) { get_material(c, face, pname, params); }
void GetMaterialiv(Context& c, GLenum face, GLenum pname, GLint* params) { get_material(c, face, pname, params); }

void GetMaterialfv(Context& c, GLenum face, GLenum pname, GLfloat* params) { get_material(c, face, pname, params); }
void GetMaterialiv(Context& c, GLenum face, GLenum pname, GLint* params) { get_material(c, face, pname, params); }

}  // namespace wall::client::api
