// SPDX-License-Identifier: MIT
// Which colour a fragment shader's output is (OpenGL 3.0, 3.9.2; 3.3): bindings take part in linking, and what came of
// them is answered from what a node has told.
#include <algorithm>
#include <string_view>

#include "client_lib/api/program_access.h"
#include "client_lib/context/limits.h"
#include "common/glstate/framebuffer.h"

namespace wall::client::api {
namespace {

/// Colours that blending can take a second one for.
GLuint dual_source_colors(Context& c) {
    return static_cast<GLuint>(limit_of(c.session().caps(), GL_MAX_DUAL_SOURCE_DRAW_BUFFERS, 1));
}

/// Calls give(output, element); false: the program has no such output, or there is an error.
template <class Give>
bool with_output(Context& c, GLuint name, const GLchar* output, Give&& give) {
    const auto program = linked_program(c, name);
    if (!program) return false;
    std::lock_guard lock(c.share().mutex);
    const Executable* executable = active(*program);
    if (!executable) return c.error(GL_INVALID_OPERATION), false;
    GLint element = 0;
    const auto* found = output ? executable->output_of(output, element) : nullptr;
    if (!found || !found->color()) return false;
    give(*found, element);
    return true;
}

}  // namespace

void BindFragDataLocationIndexed(Context& c, GLuint name, GLuint color, GLuint index, const GLchar* output) {
    const auto program = program_of(c, name);
    if (!program || !output) return;
    if (std::string_view(output).starts_with("gl_")) return c.error(GL_INVALID_OPERATION);
    if (index > 1 || color >= (index == 0 ? glstate::kColorAttachments : dual_source_colors(c)))
        return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    std::erase_if(program->output_bindings, [&](const auto& binding) { return binding.name == output; });
    program->output_bindings.push_back({color, index, output});
}

void BindFragDataLocation(Context& c, GLuint name, GLuint color, const GLchar* output) {
    BindFragDataLocationIndexed(c, name, color, 0, output);
}

GLint GetFragDataLocation(Context& c, GLuint name, const GLchar* output) {
    GLint location = -1;
    with_output(c, name, output, [&](const auto& found, GLint element) { location = found.location + element; });
    return location;
}

GLint GetFragDataIndex(Context& c, GLuint name, const GLchar* output) {
    GLint index = -1;
    with_output(c, name, output, [&](const auto& found, GLint) { index = found.index; });
    return index;
}

}  // namespace wall::client::api
