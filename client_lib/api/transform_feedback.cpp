// SPDX-License-Identifier: MIT
// Transform feedback (OpenGL 4.0, 2.17): what a program's varyings are, and from glBeginTransformFeedback to its end.
#include <algorithm>
#include <string_view>

#include "client_lib/api/array_draws.h"
#include "client_lib/api/program_access.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/captured_draw.h"
#include "client_lib/context/let_go.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/program_use.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// Which places of buffers: one for each varying, or one for all, or those that shaders name (xfb_buffer).
std::vector<bool> buffers_of(const Executable& executable) {
    std::vector<bool> named;
    for (const glapi::CaptureBuffer& each : executable.capture_buffers) {
        const std::size_t place = std::min<std::size_t>(each.binding, kCaptureBuffers);  // that one is never bound
        named.resize(std::max(named.size(), place + 1));
        named[place] = true;
    }
    if (!named.empty()) return named;
    const auto buffers =
        executable.capture_mode == GL_SEPARATE_ATTRIBS
            ? static_cast<std::ptrdiff_t>(executable.captured.size())
            : std::ranges::count(executable.captured, "gl_NextBuffer", &glapi::CapturedVarying::name) + 1;
    return std::vector<bool>(static_cast<std::size_t>(buffers), true);
}

/// Nothing: one of them is missing.
std::optional<std::vector<CapturedPart>> bound_parts(Context& c, const std::vector<bool>& wanted) {
    if (wanted.size() > kCaptureBuffers) return std::nullopt;
    std::vector<CapturedPart> parts(wanted.size());
    for (unsigned i = 0; i < wanted.size(); ++i) {
        if (!wanted[i]) continue;
        const glstate::BufferRange& range = c.get<el::feedback_buffer>(i);
        const auto found = c.buffers->by_id.find(ClientName(range.buffer));
        if (found == c.buffers->by_id.end()) return std::nullopt;
        parts[i] = {found->second, range.offset, range.size};
    }
    return parts;
}

/// Room that is left, or the next buffer (GL_ARB_transform_feedback3).
bool is_no_varying(const GLchar* name) {
    return std::string_view(name).starts_with("gl_SkipComponents") || std::string_view(name) == "gl_NextBuffer";
}

void show(Context& c) {
    const FeedbackObject& bound = c.captures->bound();
    c.set<el::transform_feedback_active>(0, bound.active != nullptr);
    c.set<el::transform_feedback_paused>(0, bound.paused);
}

void bind_object(Context& c, GLuint name, std::shared_ptr<FeedbackObject> object) {
    if (object.get() == &c.captures->bound()) return;
    for (unsigned i = 0; i < kCaptureBuffers; ++i) {
        c.captures->bound().buffers[i] = c.get<el::feedback_buffer>(i);
        c.set<el::feedback_buffer>(i, object->buffers[i]);
    }
    c.set<el::transform_feedback>(0, name);
    c.captures->bind(std::move(object));
    show(c);
}

}  // namespace

void TransformFeedbackVaryings(Context& c, GLuint name, GLsizei count, const GLchar* const* varyings, GLenum mode) {
    if (mode != GL_INTERLEAVED_ATTRIBS && mode != GL_SEPARATE_ATTRIBS) return c.error(GL_INVALID_ENUM);
    if (count < 0 || (mode == GL_SEPARATE_ATTRIBS && count > static_cast<GLsizei>(kCaptureBuffers)))
        return c.error(GL_INVALID_VALUE);
    if (mode == GL_SEPARATE_ATTRIBS && std::any_of(varyings, varyings + count, is_no_varying))
        return c.error(GL_INVALID_OPERATION);
    const auto is_next = [](const GLchar* each) { return std::string_view(each) == "gl_NextBuffer"; };
    if (std::count_if(varyings, varyings + count, is_next) >= static_cast<std::ptrdiff_t>(kCaptureBuffers))
        return c.error(GL_INVALID_OPERATION);
    const auto program = program_of(c, name);
    if (!program) return;
    if (c.captures->uses(*program)) return c.error(GL_INVALID_OPERATION);
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
    FeedbackObject& object = c.captures->bound();
    if (object.active || !c.program) return c.error(GL_INVALID_OPERATION);
    std::vector<bool> buffers;
    {
        std::lock_guard lock(c.share().mutex);
        const Executable& executable = *c.program->executable;
        if (!executable.captured.empty()) buffers = buffers_of(executable);
    }
    auto parts = !buffers.empty() ? bound_parts(c, buffers) : std::nullopt;
    if (!parts) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    object.active = std::make_shared<Capture>(mode, *std::move(parts));
    object.program = c.program;
    show(c);
}

/// The nodes keep how many vertices it were.
void EndTransformFeedback(Context& c) {
    FeedbackObject& object = c.captures->bound();
    if (!object.active) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    forget_ended(c, object);
    object.ended = std::exchange(object.active, nullptr);
    object.program = nullptr;
    object.paused = false;
    {
        std::lock_guard lock(c.share().mutex);
        object.ended->end();
        c.share().by_id[object.ended->id] = object.ended;
    }
    if (c.attached())
        c.session().on_every_node(c.id, [&](wire::PackBuffer& buffer, Node& node) {
            const auto known = node.object_stamps.find(object.ended->id);
            if (known == node.object_stamps.end() || known->second == 0) return;
            object.ended->pack_changes(known->second, buffer, no_limit);
            known->second = object.ended->latest();
        });
    for (const ClientName id : object.ended->target_ids()) c.forget_object(id);
    show(c);
}

void PauseTransformFeedback(Context& c) {
    FeedbackObject& object = c.captures->bound();
    if (!object.active || object.paused) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    object.paused = true;
    show(c);
}

void ResumeTransformFeedback(Context& c) {
    FeedbackObject& object = c.captures->bound();
    if (!object.active || !object.paused || object.program != c.program) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    object.paused = false;
    show(c);
}

// ---- objects ----

void GenTransformFeedbacks(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const GLuint first = c.captures->names.reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteTransformFeedbacks(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    for (GLsizei i = 0; i < count; ++i) {
        const auto object = c.captures->names.find(names[i]);
        if (object && object->active) return c.error(GL_INVALID_OPERATION);
    }
    for (GLsizei i = 0; i < count; ++i) {
        if (names[i] == 0) continue;
        const auto object = c.captures->names.erase(names[i]);
        if (!object) continue;
        if (object.get() == &c.captures->bound()) bind_object(c, 0, c.captures->find(0));
        forget_ended(c, *object);
    }
}

GLboolean IsTransformFeedback(Context& c, GLuint name) { return name != 0 && c.captures->names.find(name) != nullptr; }

void BindTransformFeedback(Context& c, GLenum target, GLuint name) {
    if (target != GL_TRANSFORM_FEEDBACK) return c.error(GL_INVALID_ENUM);
    if (c.captures->captures()) return c.error(GL_INVALID_OPERATION);
    if (name != 0 && !c.captures->names.known(name)) return c.error(GL_INVALID_OPERATION);
    auto object = c.captures->find(name);
    if (!object) c.captures->names.put(name, object = std::make_shared<FeedbackObject>());
    bind_object(c, name, std::move(object));
}

/// As many vertices of the arrays as were captured of a stream.
void DrawTransformFeedbackStreamInstanced(Context& c, GLenum mode, GLuint name, GLuint stream, GLsizei instances) {
    if (instances < 0 || stream >= vertex_streams(c)) return c.error(GL_INVALID_VALUE);
    const auto object = c.captures->find(name);
    if (!object) return c.error(GL_INVALID_VALUE);
    if (!object->ended) return c.error(GL_INVALID_OPERATION);
    if (!check_mode(c, mode)) return;
    if (instances != 0) draw_captured(c, {mode, object->ended, stream, instances});
}

}  // namespace wall::client::api
