// SPDX-License-Identifier: MIT
// The advanced equations of blending, and which of them a fragment shader goes with (GL_KHR_blend_equation_advanced;
// OpenGL ES 3.2, 15.1.5.1). Pure.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/glapi/gl_types.h"

namespace wall::client {

/// A bit for each of them; 0: it is none.
std::uint32_t advanced_equation_bit(GLenum equation);

/// The bits of the equations that a fragment shader's source names (`layout(blend_support_multiply) out;`). What a
/// comment names counts as well: no driver tells more.
std::uint32_t blend_support_of(std::string_view source);

}  // namespace wall::client
