// SPDX-License-Identifier: MIT
// What OpenGL ES says of the shader compiler (GL_ARB_ES2_compatibility; OpenGL 4.1, 2.11.2 and 6.1.12).
#include "client_lib/context/context.h"

namespace wall::client::api {

// Those of IEEE numbers of 32 bits, whatever precision is asked for: desktop drivers have no others. In OpenGL ES a
// driver may take 16 bits for what is not highp, and llvmpipe says so.
void GetShaderPrecisionFormat(Context& c, GLenum shader, GLenum precision, GLint* range, GLint* digits) {
    if (shader != GL_VERTEX_SHADER && shader != GL_FRAGMENT_SHADER) return c.error(GL_INVALID_ENUM);
    const bool es = c.profile.is_es();
    switch (precision) {
        case GL_LOW_FLOAT:
        case GL_MEDIUM_FLOAT:
            range[0] = range[1] = es ? 15 : 127;
            *digits = es ? 10 : 23;
            break;
        case GL_HIGH_FLOAT:
            range[0] = range[1] = 127;
            *digits = 23;
            break;
        case GL_LOW_INT:
        case GL_MEDIUM_INT:
            range[0] = es ? 15 : 31, range[1] = es ? 14 : 30;
            *digits = 0;
            break;
        case GL_HIGH_INT:
            range[0] = 31, range[1] = 30;
            *digits = 0;
            break;
        default: c.error(GL_INVALID_ENUM);
    }
}

// The nodes keep theirs.
void ReleaseShaderCompiler(Context&) {}

// There is no format that all nodes would take.
void ShaderBinary(Context& c, GLsizei count, const GLuint*, GLenum, const void*, GLsizei length) {
    c.error(count < 0 || length < 0 ? GL_INVALID_VALUE : GL_INVALID_ENUM);
}

}  // namespace wall::client::api
