// SPDX-License-Identifier: MIT
#include "client_lib/api/program_access.h"

#include <algorithm>
#include <cstring>

#include "client_lib/context/program_use.h"

namespace wall::client::api {
namespace {

template <class T>
std::shared_ptr<T> object_of(Context& c, GLuint name, GlslObject::Kind kind) {
    auto object = find_glsl_object(c, name);
    if (object && object->kind == kind) return std::static_pointer_cast<T>(object);
    c.error(object ? GL_INVALID_OPERATION : GL_INVALID_VALUE);
    return nullptr;
}

}  // namespace

std::shared_ptr<GlslObject> find_glsl_object(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().glsl_objects.find(name);
}

std::shared_ptr<Shader> shader_of(Context& c, GLuint name) {
    return object_of<Shader>(c, name, GlslObject::Kind::shader);
}

std::shared_ptr<Program> program_of(Context& c, GLuint name) {
    return object_of<Program>(c, name, GlslObject::Kind::program);
}

std::shared_ptr<Program> linked_program(Context& c, GLuint name) {
    auto program = program_of(c, name);
    if (program) learn_link_result(c, *program);
    return program;
}

void give_text(Context& c, const std::string& text, GLsizei room, GLsizei* length, GLchar* out) {
    if (room < 0) return c.error(GL_INVALID_VALUE);
    const std::size_t copied = room == 0 ? 0 : std::min(text.size(), static_cast<std::size_t>(room) - 1);
    if (out && room > 0) {
        std::memcpy(out, text.data(), copied);
        out[copied] = '\0';
    }
    if (length) *length = static_cast<GLsizei>(copied);
}

}  // namespace wall::client::api
