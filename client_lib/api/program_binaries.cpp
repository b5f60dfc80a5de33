// SPDX-License-Identifier: MIT
// Programs as the driver keeps them (GL_ARB_get_program_binary; OpenGL 4.6, 7.5; OpenGL ES 3.0.6, 2.11.4). There is no
// format that all nodes would take, so that no program is given out, and none is taken.
#include "client_lib/api/program_access.h"

namespace wall::client::api {

void GetProgramBinary(Context& c, GLuint name, GLsizei room, GLsizei* length, GLenum*, void*) {
    const auto program = linked_program(c, name);
    if (!program) return;
    if (room < 0) return c.error(GL_INVALID_VALUE);
    if (length) *length = 0;
    c.error(GL_INVALID_OPERATION);  // it is not linked, or there is no format
}

// A binary that is not taken leaves a program that is not linked.
void ProgramBinary(Context& c, GLuint name, GLenum, const void*, GLsizei length) {
    const auto program = program_of(c, name);
    if (!program) return;
    if (length < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    program->to_link.reset();
    program->linked = false;
    c.error(GL_INVALID_ENUM);
}

}  // namespace wall::client::api
