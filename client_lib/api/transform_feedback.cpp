// SPDX-License-Identifier: MIT
// Transform feedback (OpenGL 3.0, 2.15).
#include <algorithm>

#include "client_lib/api/program_access.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// One for each varying, or one for all.
std::size_t buffers_of(const Executable& executable) {
    if (executable.capture_mode == GL_SEPARATE_ATTRIBS) return executable.captured.size();
    return static_cast<std::size_t>(
               std::ranges::count(executable.captured, "gl_NextBuffer", &glapi::CapturedVarying::name)) +
           1;
}

/// Nothing: one of them is missing.
std::optional<std::vector<CapturedPart>> bound_parts(Context& c, std::size_t count) {
    if (count > kCaptureBuffers) return std::nullopt;
    std::vector<CapturedPart> parts;
    for (unsigned i = 0; i < count; ++i) {
        const glstate::BufferRange& range = c.get<el::feedback_buffer>(i);
        const auto found = c.buffers->by_id.find(ClientName(range.buffer));
        if (found == c.buffers->by_id.end()) return std::nullopt;
        parts.push_back({found->second, range.offset, range.size});
    }
    return parts;
}

}  // namespace

void TransformFeedbackVaryings(Context& c, GLuint name, GLsizei count, const GLchar* const* varyings, GLenum mode) {
    if (mode != GL_INTERLEAVED_ATTRIBS && mode != GL_SEPARATE_ATTRIBS) return c.error(GL_INVALID_ENUM);
    if (count < 0 || (mode == GL_SEPARATE_ATTRIBS && count > static_cast<GLsizei>(kCaptureBuffers)))
        return c.error(GL_INVALID_VALUE);
    const auto program = program_of(c, name);
    if (!program) return;
    if (c.captures->active && c.captures->program == program) return c.error(GL_INVALID_OPERATION);
    std::lock_guard lock(c.share().mutex);
    program->feedback = {mode, {}};
    for (GLsizei i = 0; i < count; ++i) program->feedback.names.emplace_back(varyings[i]);
}

void GetTransformFeedbackVarying(Context& c, GLuint name, GLuint index, GLsizei room, GLsizei* length, GLsizei* size,
                                 GLenum* type, GLchar* out) {
    const auto program = linked_program(c, name);
    if (!program) return;
    std::lock_guard lock(c.share().mutex);
    const Executable* executable = active(*program);
    if (!executable || index >= executable->captured.size()) return c.error(GL_INVALID_VALUE);
    const auto& varying = executable->captured[index];
    give_text(c, varying.name, room, length, out);
    if (size) *size = static_cast<GLsizei>(varying.size);
    if (type) *type = varying.type;
}

void BeginTransformFeedback(Context& c, GLenum mode) {
    if (mode != GL_POINTS && mode != GL_LINES && mode != GL_TRIANGLES) return c.error(GL_INVALID_ENUM);
    if (c.captures->active || !c.program) return c.error(GL_INVALID_OPERATION);
    std::size_t buffers = 0;
    {
        std::lock_guard lock(c.share().mutex);
        const Executable& executable = *c.program->executable;
        if (!executable.captured.empty()) buffers = buffers_of(executable);
    }
    auto parts = buffers != 0 ? bound_parts(c, buffers) : std::nullopt;
    if (!parts) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    c.captures->active = std::make_shared<Capture>(mode, *std::move(parts));
    c.captures->program = c.program;
}

void EndTransformFeedback(Context& c) {
    if (!c.captures->active) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    const auto ended = std::exchange(c.captures->active, nullptr);
    c.captures->program = nullptr;
    for (const ClientName id : ended->own_ids()) c.forget_object(id);
}

}  // namespace wall::client::api
