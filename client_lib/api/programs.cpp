// SPDX-License-Identifier: MIT
// Shaders and programs (OpenGL 2.1, 2.15 and 6.1.14): names are given here, one node is asked how compiling and linking
// went, and all queries are answered from the shadow.
#include <algorithm>
#include <optional>

#include "client_lib/api/program_access.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/program_use.h"
#include "client_lib/objects/program_pipeline.h"
#include "client_lib/objects/shader_version.h"

namespace wall::client::api {
namespace {

template <class T, class... Args>
GLuint create(Context& c, Args... args) {
    ShareGroup& share = c.share();
    std::lock_guard lock(share.mutex);
    const GLuint name = share.glsl_objects.reserve(1);
    const auto object = std::make_shared<T>(next_object_id(), name, args...);
    share.glsl_objects.put(name, object);
    if (object->kind == GlslObject::Kind::program) share.by_id[object->id] = object;
    return name;
}

bool has_stage(const Program& program, GLenum type) {
    return std::ranges::any_of(program.shaders, [&](const auto& shader) { return shader->type == type; });
}

/// OpenGL ES has no fixed function in place of a shader (Mesa's words). Null: the program has both, or needs none of
/// them (OpenGL ES 3.1, 7.3).
const char* lacking_stage(const Program& program) {
    if (program.separable || has_stage(program, GL_COMPUTE_SHADER)) return nullptr;
    if (!has_stage(program, GL_VERTEX_SHADER)) return "vertex";
    return has_stage(program, GL_FRAGMENT_SHADER) ? nullptr : "fragment";
}

/// With the terminating zero; 0 for nothing.
GLint text_length(const std::string& text) { return text.empty() ? 0 : static_cast<GLint>(text.size() + 1); }

GLint active_value(const Program& program, GLenum pname) {
    const Executable* executable = active(program);
    if (!executable) return 0;
    switch (pname) {
        case GL_ACTIVE_UNIFORMS: return static_cast<GLint>(executable->uniforms.size());
        case GL_ACTIVE_ATTRIBUTES: return static_cast<GLint>(executable->attributes.size());
        case GL_ACTIVE_UNIFORM_MAX_LENGTH:
            return longest_name(executable->uniforms, [](const Uniform& u) { return u.full_name(); });
        case GL_TRANSFORM_FEEDBACK_VARYINGS: return static_cast<GLint>(executable->captured.size());
        case GL_TRANSFORM_FEEDBACK_BUFFER_MODE: return static_cast<GLint>(executable->capture_mode);
        case GL_TRANSFORM_FEEDBACK_VARYING_MAX_LENGTH:
            return longest_name(executable->captured, [](const glapi::CapturedVarying& v) { return v.name; });
        case GL_ACTIVE_ATOMIC_COUNTER_BUFFERS: return static_cast<GLint>(executable->counter_buffers.size());
        case GL_ACTIVE_UNIFORM_BLOCKS: return static_cast<GLint>(executable->blocks.size());
        case GL_ACTIVE_UNIFORM_BLOCK_MAX_NAME_LENGTH:
            return longest_name(executable->blocks, [](const UniformBlock& b) { return b.name; });
        default: return longest_name(executable->attributes, [](const glapi::ActiveAttribute& a) { return a.name; });
    }
}

/// Null: no such word.
GLuint glapi::GeometryStage::*field_of_geometry_stage(GLenum pname) {
    switch (pname) {
        case GL_GEOMETRY_INPUT_TYPE: return &glapi::GeometryStage::input;
        case GL_GEOMETRY_OUTPUT_TYPE: return &glapi::GeometryStage::output;
        case GL_GEOMETRY_VERTICES_OUT: return &glapi::GeometryStage::vertices;
        case GL_GEOMETRY_SHADER_INVOCATIONS: return &glapi::GeometryStage::invocations;
        default: return nullptr;
    }
}

/// Null: no such word of evaluation shaders.
GLuint glapi::TessellationStage::*field_of_evaluation_stage(GLenum pname) {
    switch (pname) {
        case GL_TESS_GEN_MODE: return &glapi::TessellationStage::mode;
        case GL_TESS_GEN_SPACING: return &glapi::TessellationStage::spacing;
        case GL_TESS_GEN_VERTEX_ORDER: return &glapi::TessellationStage::order;
        case GL_TESS_GEN_POINT_MODE: return &glapi::TessellationStage::point_mode;
        default: return nullptr;
    }
}

/// Of the stages between that of vertices and that of fragments. False: no such word; nothing: the program has no such
/// stage.
bool answer_stage(const Executable* executable, GLenum pname, std::optional<GLuint>& value) {
    const auto of_geometry = field_of_geometry_stage(pname);
    const auto of_evaluation = field_of_evaluation_stage(pname);
    if (!of_geometry && !of_evaluation && pname != GL_TESS_CONTROL_OUTPUT_VERTICES) return false;
    if (!executable) return true;
    const glapi::TessellationStage& tessellation = executable->tessellation;
    if (of_geometry && executable->geometry.exists()) value = executable->geometry.*of_geometry;
    if (of_evaluation && tessellation.exists()) value = tessellation.*of_evaluation;
    if (!of_geometry && !of_evaluation && tessellation.vertices != 0) value = tessellation.vertices;
    return true;
}

}  // namespace

// ---- shaders ----

GLuint CreateShader(Context& c, GLenum type) {
    if (std::ranges::find(glapi::kShaderStages, type) != std::end(glapi::kShaderStages)) return create<Shader>(c, type);
    c.error(GL_INVALID_ENUM);
    return 0;
}

void DeleteShader(Context& c, GLuint name) {
    if (name == 0) return;
    if (const auto shader = shader_of(c, name)) delete_object(c, shader);
}

GLboolean IsShader(Context& c, GLuint name) {
    const auto object = find_glsl_object(c, name);
    return object && object->kind == GlslObject::Kind::shader;
}

void ShaderSource(Context& c, GLuint name, GLsizei count, const GLchar* const* strings, const GLint* lengths) {
    const auto shader = shader_of(c, name);
    if (!shader) return;
    if (count < 0 || !strings) return c.error(GL_INVALID_VALUE);
    std::string source;
    for (GLsizei i = 0; i < count; ++i) {
        if (!strings[i]) return c.error(GL_INVALID_OPERATION);
        if (lengths && lengths[i] >= 0) source.append(strings[i], static_cast<std::size_t>(lengths[i]));
        else source.append(strings[i]);
    }
    std::lock_guard lock(c.share().mutex);
    shader->source = std::move(source);
}

void CompileShader(Context& c, GLuint name) {
    const auto shader = shader_of(c, name);
    if (!shader) return;
    std::lock_guard lock(c.share().mutex);
    EsSource es;
    if (c.profile.is_es()) es = es_source(shader->source, c.profile.es);
    const std::string& source = c.profile.is_es() ? es.source : shader->source;
    const bool known = shader->state == Shader::State::compiled || shader->state == Shader::State::failed;
    if (known && shader->compiled_source == source) return;  // it would go as it went
    shader->compiled_source = source;
    shader->state = es.error.empty() ? Shader::State::unknown : Shader::State::failed;
    shader->log = std::move(es.error);
}

void GetShaderiv(Context& c, GLuint name, GLenum pname, GLint* params) {
    const auto shader = shader_of(c, name);
    if (!shader) return;
    if (pname == GL_COMPILE_STATUS || pname == GL_INFO_LOG_LENGTH) learn_compile_result(c, *shader);
    std::lock_guard lock(c.share().mutex);
    switch (pname) {
        case GL_SHADER_TYPE: *params = static_cast<GLint>(shader->type); break;
        case GL_DELETE_STATUS: *params = shader->deleted; break;
        case GL_COMPILE_STATUS: *params = shader->state == Shader::State::compiled; break;
        case GL_INFO_LOG_LENGTH: *params = text_length(shader->log); break;
        case GL_SHADER_SOURCE_LENGTH: *params = text_length(shader->source); break;
        default: c.error(GL_INVALID_ENUM);
    }
}

void GetShaderInfoLog(Context& c, GLuint name, GLsizei room, GLsizei* length, GLchar* out) {
    const auto shader = shader_of(c, name);
    if (!shader) return;
    learn_compile_result(c, *shader);
    std::lock_guard lock(c.share().mutex);
    give_text(c, shader->log, room, length, out);
}

void GetShaderSource(Context& c, GLuint name, GLsizei room, GLsizei* length, GLchar* out) {
    const auto shader = shader_of(c, name);
    if (!shader) return;
    std::lock_guard lock(c.share().mutex);
    give_text(c, shader->source, room, length, out);
}

// ---- programs ----

GLuint CreateProgram(Context& c) { return create<Program>(c); }

void DeleteProgram(Context& c, GLuint name) {
    if (name == 0) return;
    if (const auto program = program_of(c, name)) delete_object(c, program);
}

GLboolean IsProgram(Context& c, GLuint name) {
    const auto object = find_glsl_object(c, name);
    return object && object->kind == GlslObject::Kind::program;
}

void AttachShader(Context& c, GLuint program_name, GLuint shader_name) {
    const auto program = program_of(c, program_name);
    const auto shader = program ? shader_of(c, shader_name) : nullptr;
    if (!shader) return;
    std::lock_guard lock(c.share().mutex);
    if (std::find(program->shaders.begin(), program->shaders.end(), shader) != program->shaders.end())
        return c.error(GL_INVALID_OPERATION);
    if (c.profile.is_es() && has_stage(*program, shader->type)) return c.error(GL_INVALID_OPERATION);
    program->shaders.push_back(shader);
    ++shader->users;
}

void DetachShader(Context& c, GLuint program_name, GLuint shader_name) {
    const auto program = program_of(c, program_name);
    const auto shader = program ? shader_of(c, shader_name) : nullptr;
    if (!shader) return;
    {
        std::lock_guard lock(c.share().mutex);
        if (std::erase(program->shaders, shader) == 0) return c.error(GL_INVALID_OPERATION);
    }
    drop_user(c, shader);
}

void BindAttribLocation(Context& c, GLuint name, GLuint index, const GLchar* attribute) {
    const auto program = program_of(c, name);
    if (!program || !attribute) return;
    if (std::string_view(attribute).starts_with("gl_")) return c.error(GL_INVALID_OPERATION);
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    program->attribute_bindings[attribute] = index;
}

void LinkProgram(Context& c, GLuint name) {
    const auto program = program_of(c, name);
    if (!program) return;
    if (c.captures->uses(*program)) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    bool in_use = false;
    {
        std::lock_guard lock(c.share().mutex);
        program->to_link.reset();
        program->binary_hint = program->next_binary_hint;
        if (const char* lacking = c.profile.is_es() ? lacking_stage(*program) : nullptr) {
            program->linked = false;
            program->log = std::string("error: program lacks a ") + lacking + " shader\n";
            return;
        }
        program->validated = false;
        if (c.profile.core && program->shaders.empty()) {  // in others fixed function takes their place
            program->to_link.reset();
            program->linked = false;
            program->log = "error: no shaders attached to the program\n";
            return;
        }
        program->to_link = program->definition();
        in_use = program->users != 0;
    }
    if (in_use) learn_link_result(c, *program);
}

void ValidateProgram(Context& c, GLuint name) {
    const auto program = linked_program(c, name);
    if (!program) return;
    std::lock_guard lock(c.share().mutex);
    program->validated = program->linked && !program->executable->samplers_conflict();
}

void UseProgram(Context& c, GLuint name) {
    if (c.captures->captures()) return c.error(GL_INVALID_OPERATION);
    std::shared_ptr<Program> program;
    if (name != 0) {
        program = linked_program(c, name);
        if (!program) return;
        if (!program->linked) return c.error(GL_INVALID_OPERATION);
    }
    c.pipelines->used = program;
    use_program(c, program ? program : c.pipelines->bound);
}

void GetProgramiv(Context& c, GLuint name, GLenum pname, GLint* params) {
    const auto program = program_of(c, name);
    if (!program) return;
    if (pname != GL_DELETE_STATUS && pname != GL_ATTACHED_SHADERS) learn_link_result(c, *program);
    std::lock_guard lock(c.share().mutex);
    if (std::optional<GLuint> value; answer_stage(active(*program), pname, value)) {
        if (!value) return c.error(GL_INVALID_OPERATION);
        *params = static_cast<GLint>(*value);
        return;
    }
    if (pname == GL_COMPUTE_WORK_GROUP_SIZE) {
        const Executable* executable = active(*program);
        if (!executable || !executable->computes()) return c.error(GL_INVALID_OPERATION);
        std::ranges::copy(executable->group_size, params);
        return;
    }
    switch (pname) {
        case GL_DELETE_STATUS: *params = program->deleted; break;
        case GL_PROGRAM_SEPARABLE: *params = program->separable; break;
        case GL_LINK_STATUS: *params = program->linked; break;
        case GL_VALIDATE_STATUS: *params = program->validated; break;
        case GL_INFO_LOG_LENGTH: *params = text_length(program->log); break;
        case GL_ATTACHED_SHADERS: *params = static_cast<GLint>(program->shaders.size()); break;
        case GL_PROGRAM_BINARY_RETRIEVABLE_HINT: *params = program->binary_hint; break;
        case GL_PROGRAM_BINARY_LENGTH: *params = 0; break;
        case GL_ACTIVE_UNIFORMS:
        case GL_ACTIVE_UNIFORM_MAX_LENGTH:
        case GL_TRANSFORM_FEEDBACK_VARYINGS:
        case GL_TRANSFORM_FEEDBACK_BUFFER_MODE:
        case GL_TRANSFORM_FEEDBACK_VARYING_MAX_LENGTH:
        case GL_ACTIVE_UNIFORM_BLOCKS:
        case GL_ACTIVE_ATOMIC_COUNTER_BUFFERS:
        case GL_ACTIVE_UNIFORM_BLOCK_MAX_NAME_LENGTH:
        case GL_ACTIVE_ATTRIBUTES:
        case GL_ACTIVE_ATTRIBUTE_MAX_LENGTH: *params = active_value(*program, pname); break;
        default: c.error(GL_INVALID_ENUM);
    }
}

void GetProgramInfoLog(Context& c, GLuint name, GLsizei room, GLsizei* length, GLchar* out) {
    const auto program = linked_program(c, name);
    if (!program) return;
    std::lock_guard lock(c.share().mutex);
    give_text(c, program->log, room, length, out);
}

void ProgramParameteri(Context& c, GLuint name, GLenum pname, GLint value) {
    const auto program = program_of(c, name);
    if (!program) return;
    if (pname != GL_PROGRAM_SEPARABLE && pname != GL_PROGRAM_BINARY_RETRIEVABLE_HINT) return c.error(GL_INVALID_ENUM);
    if (value != GL_FALSE && value != GL_TRUE) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    (pname == GL_PROGRAM_SEPARABLE ? program->separable : program->next_binary_hint) = value != GL_FALSE;
}

void GetAttachedShaders(Context& c, GLuint name, GLsizei room, GLsizei* count, GLuint* shaders) {
    const auto program = program_of(c, name);
    if (!program) return;
    if (room < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    const std::size_t given = std::min(program->shaders.size(), static_cast<std::size_t>(room));
    for (std::size_t i = 0; i < given; ++i) shaders[i] = program->shaders[i]->name;
    if (count) *count = static_cast<GLsizei>(given);
}

// ---- what is active in a program ----

GLint GetUniformLocation(Context& c, GLuint name, const GLchar* uniform) {
    const auto program = linked_program(c, name);
    if (!program) return -1;
    std::lock_guard lock(c.share().mutex);
    if (program->linked && uniform) return program->executable->location_of(uniform);
    c.error(GL_INVALID_OPERATION);
    return -1;
}

GLint GetAttribLocation(Context& c, GLuint name, const GLchar* attribute) {
    const auto program = linked_program(c, name);
    if (!program) return -1;
    std::lock_guard lock(c.share().mutex);
    if (program->linked && attribute) return program->executable->attribute_location_of(attribute);
    c.error(GL_INVALID_OPERATION);
    return -1;
}

void GetActiveUniform(Context& c, GLuint name, GLuint index, GLsizei room, GLsizei* length, GLint* size, GLenum* type,
                      GLchar* out) {
    const auto program = linked_program(c, name);
    if (!program) return;
    std::lock_guard lock(c.share().mutex);
    const Executable* executable = active(*program);
    if (!executable || index >= executable->uniforms.size()) return c.error(GL_INVALID_VALUE);
    const Uniform& uniform = executable->uniforms[index];
    give_text(c, uniform.full_name(), room, length, out);
    if (size) *size = uniform.size;
    if (type) *type = uniform.type->type;
}

void GetActiveAttrib(Context& c, GLuint name, GLuint index, GLsizei room, GLsizei* length, GLint* size, GLenum* type,
                     GLchar* out) {
    const auto program = linked_program(c, name);
    if (!program) return;
    std::lock_guard lock(c.share().mutex);
    const Executable* executable = active(*program);
    if (!executable || index >= executable->attributes.size()) return c.error(GL_INVALID_VALUE);
    const auto& attribute = executable->attributes[index];
    give_text(c, attribute.name, room, length, out);
    if (size) *size = static_cast<GLint>(attribute.size);
    if (type) *type = attribute.type;
}

}  // namespace wall::client::api
