// SPDX-License-Identifier: MIT
// Material parameters (OpenGL 1.2.1, 2.13.2) as values of a state. Pure.
#pragma once

#include "gen/glstate/state.gen.h"

namespace wall::client {

/// A glMaterial among vertices.
struct MaterialChange {
    GLenum face, pname;
    glstate::Vec4 value;
};

/// Whether the two words may stand in glMaterial.
bool valid_material(GLenum face, GLenum pname);

/// Whether glMaterial would change a value.
bool changes_material(const glstate::State& state, GLenum face, GLenum pname, const glstate::Vec4& value);
/// What glMaterial does to a state. Parameters that follow the current colour (glColorMaterial) stay.
void assign_material(glstate::State& state, GLenum face, GLenum pname, const glstate::Vec4& value);

}  // namespace wall::client
