// SPDX-License-Identifier: MIT
// glBlendEquation and glBlendEquationi, which also take the advanced equations (GL_KHR_blend_equation_advanced; OpenGL
// ES 3.2, 15.1.5.1).
#include "client_lib/context/indexed_values.h"
#include "client_lib/objects/blend_support.h"

namespace wall::client::api {

namespace el = glstate::el;

void BlendEquation(Context& c, GLenum mode) {
    if (advanced_equation_bit(mode) == 0) return BlendEquationSeparate(c, mode, mode);
    set_everywhere<el::blend_equation, el::blend_equation_rest>(c, {mode, mode});
}

void BlendEquationi(Context& c, GLuint buffer, GLenum mode) {
    if (advanced_equation_bit(mode) == 0) return BlendEquationSeparatei(c, buffer, mode, mode);
    if (buffer >= draw_buffers_of(c)) return c.error(GL_INVALID_VALUE);
    set_at<el::blend_equation, el::blend_equation_rest>(c, buffer, {mode, mode});
}

}  // namespace wall::client::api
