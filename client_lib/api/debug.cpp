// SPDX-License-Identifier: MIT
// GL_KHR_debug (OpenGL 4.3, chapter 20) and GL_ARB_debug_output, which is the same by other names. Messages are made
// here, about errors and by the program; what nodes' drivers say stays there.
#include <algorithm>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "client_lib/context/capture_use.h"
#include "client_lib/context/context.h"
#include "client_lib/context/debug_state.h"
#include "client_lib/context/fence_object.h"
#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/lists.h"
#include "client_lib/context/query_state.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/objects/program_pipeline.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

bool by_program(GLenum source) {
    return source == GL_DEBUG_SOURCE_APPLICATION || source == GL_DEBUG_SOURCE_THIRD_PARTY;
}

/// A text of a program, which may end with a zero. Nothing, and the error is set: it is too long.
std::optional<std::string> text_of(Context& c, GLsizei length, const GLchar* text, std::size_t most) {
    const std::size_t size = length < 0 ? std::strlen(text) : static_cast<std::size_t>(length);
    if (size >= most) return c.error(GL_INVALID_VALUE), std::nullopt;
    return std::string(text, size);
}

/// Gives as much as there is room for, with a zero behind it. No room: how long it is.
void give_text(const std::string& text, GLsizei room, GLsizei* length, GLchar* out) {
    std::size_t given = text.size();
    if (room > 0 && out) {
        given = std::min(given, static_cast<std::size_t>(room) - 1);
        std::memcpy(out, text.data(), given);
        out[given] = 0;
    }
    if (length) *length = static_cast<GLsizei>(given);
}

/// An object by its kind's word and its name, and where its label is kept.
struct Labelled {
    std::shared_ptr<void> object;  ///< null, and it exists: nobody holds it
    ObjectLabels* labels;
};

/// Nothing, and the error is set: there is no such kind, or no such object. The share group's mutex is held.
std::optional<Labelled> find_object(Context& c, GLenum kind, GLuint name) {
    ShareGroup& share = c.share();
    std::shared_ptr<void> object;
    ObjectLabels* labels = share.labels.get();
    switch (kind) {
        case GL_BUFFER: object = share.buffers.find(name); break;
        case GL_TEXTURE: object = share.textures.find(name); break;
        case GL_RENDERBUFFER: object = share.renderbuffers.find(name); break;
        case GL_SAMPLER: object = share.samplers.find(name); break;
        case GL_DISPLAY_LIST: object = share.lists.find(name); break;
        case GL_SHADER:
        case GL_PROGRAM: {
            const auto found = share.glsl_objects.find(name);
            if (found && (found->kind == GlslObject::Kind::shader) == (kind == GL_SHADER)) object = found;
            break;
        }
        case GL_QUERY: object = c.queries->names.find(name), labels = &c.debug->labels; break;
        case GL_FRAMEBUFFER: object = c.framebuffers->names.find(name), labels = &c.debug->labels; break;
        case GL_VERTEX_ARRAY:
            if (c.vertex_array_objects->exists(name)) return Labelled{nullptr, &c.debug->labels};
            break;
        case GL_PROGRAM_PIPELINE: object = c.pipelines->names.find(name), labels = &c.debug->labels; break;
        case GL_TRANSFORM_FEEDBACK: object = c.captures->names.find(name), labels = &c.debug->labels; break;
        default: return c.error(GL_INVALID_ENUM), std::nullopt;
    }
    if (!object) return c.error(GL_INVALID_VALUE), std::nullopt;
    return Labelled{std::move(object), labels};
}

/// The same of sync objects, which have a handle instead of a name.
std::shared_ptr<FenceObject> find_sync(Context& c, const void* handle) {
    const auto found = c.share().fences.find(static_cast<GLsync>(const_cast<void*>(handle)));
    if (found != c.share().fences.end()) return found->second;
    c.error(GL_INVALID_VALUE);
    return nullptr;
}

}  // namespace

void DebugMessageControl(Context& c, GLenum source, GLenum type, GLenum severity, GLsizei count, const GLuint* ids,
                         GLboolean enabled) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const auto is = [](GLenum word, bool (*one)(GLenum)) { return word == GL_DONT_CARE || one(word); };
    if (!is(source, DebugLog::is_source) || !is(type, DebugLog::is_type) || !is(severity, DebugLog::is_severity))
        return c.error(GL_INVALID_ENUM);
    if (count > 0 && (severity != GL_DONT_CARE || type == GL_DONT_CARE || source == GL_DONT_CARE))
        return c.error(GL_INVALID_OPERATION);
    c.debug->log.control(source, type, severity, std::vector<GLuint>(ids, ids + count), enabled != 0);
}

void DebugMessageInsert(Context& c, GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                        const GLchar* text) {
    const bool group = type == GL_DEBUG_TYPE_PUSH_GROUP || type == GL_DEBUG_TYPE_POP_GROUP;
    if (!by_program(source) || !DebugLog::is_type(type) || group || !DebugLog::is_severity(severity))
        return c.error(GL_INVALID_ENUM);
    auto message = text_of(c, length, text, DebugLog::kMostText);
    if (message && c.state.local.debug_output) c.debug->log.say({source, type, id, severity, std::move(*message)});
}

void DebugMessageCallback(Context& c, GLDEBUGPROC callback, const void* user) {
    c.debug->log.callback = callback;
    c.debug->log.user = user;
}

GLuint GetDebugMessageLog(Context& c, GLuint count, GLsizei room, GLenum* sources, GLenum* types, GLuint* ids,
                          GLenum* severities, GLsizei* lengths, GLchar* texts) {
    if (texts && room < 0) return c.error(GL_INVALID_VALUE), 0u;
    auto& logged = c.debug->log.logged;
    GLuint given = 0;
    for (; given < count && !logged.empty(); ++given, logged.pop_front()) {
        const DebugMessage& message = logged.front();
        const auto bytes = static_cast<GLsizei>(message.text.size() + 1);
        if (texts) {
            if (room < bytes) break;
            std::memcpy(texts, message.text.c_str(), static_cast<std::size_t>(bytes));
            texts += bytes;
            room -= bytes;
        }
        if (sources) sources[given] = message.source;
        if (types) types[given] = message.type;
        if (ids) ids[given] = message.id;
        if (severities) severities[given] = message.severity;
        if (lengths) lengths[given] = bytes;
    }
    return given;
}

void PushDebugGroup(Context& c, GLenum source, GLuint id, GLsizei length, const GLchar* text) {
    if (!by_program(source)) return c.error(GL_INVALID_ENUM);
    auto message = text_of(c, length, text, DebugLog::kMostText);
    if (message && !c.debug->log.push_group({source, 0, id, 0, std::move(*message)}, c.state.local.debug_output != 0))
        c.error(GL_STACK_OVERFLOW);
}

void PopDebugGroup(Context& c) {
    if (!c.debug->log.pop_group(c.state.local.debug_output != 0)) c.error(GL_STACK_UNDERFLOW);
}

void ObjectLabel(Context& c, GLenum kind, GLuint name, GLsizei length, const GLchar* label) {
    std::lock_guard lock(c.share().mutex);
    const auto found = find_object(c, kind, name);
    auto text = !found ? std::nullopt : label ? text_of(c, length, label, ObjectLabels::kMostText) : std::string();
    if (text) found->labels->set(kind, name, found->object, std::move(*text));
}

void GetObjectLabel(Context& c, GLenum kind, GLuint name, GLsizei room, GLsizei* length, GLchar* label) {
    if (room < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    const auto found = find_object(c, kind, name);
    if (found) give_text(found->labels->get(kind, name, found->object), room, length, label);
}

void ObjectPtrLabel(Context& c, const void* handle, GLsizei length, const GLchar* label) {
    std::lock_guard lock(c.share().mutex);
    const auto sync = find_sync(c, handle);
    if (!sync) return;
    auto text = label ? text_of(c, length, label, ObjectLabels::kMostText) : std::string();
    if (text) sync->label = std::move(*text);
}

void GetObjectPtrLabel(Context& c, const void* handle, GLsizei room, GLsizei* length, GLchar* label) {
    if (room < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    if (const auto sync = find_sync(c, handle)) give_text(sync->label, room, length, label);
}

}  // namespace wall::client::api
