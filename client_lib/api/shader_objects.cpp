// SPDX-License-Identifier: MIT
// ARB_shader_objects where it is not OpenGL 2.0 under other names: its functions take shaders and programs alike.
#include "client_lib/context/program_use.h"

namespace wall::client::api {
namespace {

/// 0 for neither.
GLenum kind_of(Context& c, GLhandleARB name) {
    std::lock_guard lock(c.share().mutex);
    const auto object = c.share().glsl_objects.find(name);
    if (!object) return 0;
    return object->kind == GlslObject::Kind::shader ? GL_SHADER_OBJECT_ARB : GL_PROGRAM_OBJECT_ARB;
}

}  // namespace

void DeleteObjectARB(Context& c, GLhandleARB name) {
    const GLenum kind = kind_of(c, name);
    if (kind == GL_SHADER_OBJECT_ARB) DeleteShader(c, name);
    else if (kind == GL_PROGRAM_OBJECT_ARB) DeleteProgram(c, name);
    else if (name != 0) c.error(GL_INVALID_VALUE);
}

GLhandleARB GetHandleARB(Context& c, GLenum pname) {
    if (pname == GL_PROGRAM_OBJECT_ARB) return c.program ? c.program->name : 0;
    c.error(GL_INVALID_ENUM);
    return 0;
}

void GetObjectParameterivARB(Context& c, GLhandleARB name, GLenum pname, GLint* params) {
    const GLenum kind = kind_of(c, name);
    if (kind == 0) return c.error(GL_INVALID_VALUE);
    if (pname == GL_OBJECT_TYPE_ARB) *params = static_cast<GLint>(kind);
    else if (kind == GL_PROGRAM_OBJECT_ARB) GetProgramiv(c, name, pname, params);
    else GetShaderiv(c, name, pname == GL_OBJECT_SUBTYPE_ARB ? GLenum{GL_SHADER_TYPE} : pname, params);
}

void GetObjectParameterfvARB(Context& c, GLhandleARB name, GLenum pname, GLfloat* params) {
    GLint value = 0;
    GetObjectParameterivARB(c, name, pname, &value);
    *params = static_cast<GLfloat>(value);
}

void GetInfoLogARB(Context& c, GLhandleARB name, GLsizei room, GLsizei* length, GLcharARB* text) {
    if (kind_of(c, name) == GL_PROGRAM_OBJECT_ARB) GetProgramInfoLog(c, name, room, length, text);
    else GetShaderInfoLog(c, name, room, length, text);
}

void GetAttachedObjectsARB(Context& c, GLhandleARB program, GLsizei room, GLsizei* count, GLhandleARB* shaders) {
    GetAttachedShaders(c, program, room, count, shaders);
}

}  // namespace wall::client::api
