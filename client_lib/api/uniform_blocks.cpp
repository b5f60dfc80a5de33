// SPDX-License-Identifier: MIT
// Blocks of uniforms (OpenGL 3.1, 2.11.4): what there is of them, and which binding each takes its values from.
#include <string>

#include "client_lib/api/program_access.h"
#include "client_lib/objects/program_interfaces.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

/// Calls use(executable) with the share group's mutex held; not linked: there is nothing in it.
template <class Use>
void with_executable(Context& c, GLuint name, Use&& use) {
    const auto program = linked_program(c, name);
    if (!program) return;
    std::lock_guard lock(c.share().mutex);
    static const Executable kNothing;
    const Executable* executable = active(*program);
    use(executable ? *executable : kNothing);
}

/// The same with a block of it, or an error.
template <class Use>
void with_block(Context& c, GLuint name, GLuint index, Use&& use) {
    with_executable(c, name, [&](const Executable& executable) {
        if (index >= executable.blocks.size()) return c.error(GL_INVALID_VALUE);
        use(executable, executable.blocks[index]);
    });
}

/// Calls use(uniform index) for the atomic counters in a buffer.
template <class Use>
void for_each_counter(const Executable& executable, GLuint buffer, Use&& use) {
    for (std::size_t i = 0; i < executable.uniforms.size(); ++i)
        if (executable.uniforms[i].counter_buffer == static_cast<GLint>(buffer)) use(static_cast<GLint>(i));
}

/// Whether a stage of the kind takes part.
bool is_active_in(std::uint32_t stages, GLenum stage) {
    for (std::size_t i = 0; i < std::size(glapi::kShaderStages); ++i)
        if (glapi::kShaderStages[i] == stage) return (stages >> i & 1) != 0;
    return false;
}

/// False: no such word.
bool get_of_uniform(const Uniform& uniform, GLenum pname, GLint& out) {
    switch (pname) {
        case GL_UNIFORM_TYPE: out = static_cast<GLint>(uniform.type->type); return true;
        case GL_UNIFORM_SIZE: out = uniform.size; return true;
        case GL_UNIFORM_NAME_LENGTH: out = static_cast<GLint>(uniform.full_name().size() + 1); return true;
        case GL_UNIFORM_BLOCK_INDEX: out = uniform.place.block; return true;
        case GL_UNIFORM_OFFSET: out = uniform.place.offset; return true;
        case GL_UNIFORM_ARRAY_STRIDE: out = uniform.place.array_stride; return true;
        case GL_UNIFORM_MATRIX_STRIDE: out = uniform.place.matrix_stride; return true;
        case GL_UNIFORM_ATOMIC_COUNTER_BUFFER_INDEX: out = uniform.counter_buffer; return true;
        case GL_UNIFORM_IS_ROW_MAJOR: out = uniform.place.row_major; return true;
        default: return false;
    }
}

}  // namespace

GLuint GetUniformBlockIndex(Context& c, GLuint name, const GLchar* block) {
    GLuint index = GL_INVALID_INDEX;
    with_executable(c, name, [&](const Executable& executable) {
        if (block) index = executable.block_index_of(block).value_or(GL_INVALID_INDEX);
    });
    return index;
}

namespace {

/// Of the executable's `blocks`, for which there are so many places.
template <class Blocks>
void bind_block(Context& c, GLuint name, GLuint index, GLuint binding, Blocks Executable::*blocks, GLuint places) {
    const auto program = linked_program(c, name);
    if (!program) return;
    const auto bind = [&] {
        Executable* executable = program->linked ? program->executable.get() : nullptr;
        if (!executable || index >= (executable->*blocks).size()) return c.error(GL_INVALID_VALUE), true;
        if (binding >= places) return c.error(GL_INVALID_VALUE), true;
        auto& block = (executable->*blocks)[index];
        if (block.binding == binding) return true;
        if (!c.packer.empty()) return false;  // it is sent with the binding that it was drawn with
        executable->bind_block(block, binding);
        c.share().last_change = executable->last_change;
        return true;
    };
    std::unique_lock lock(c.share().mutex);
    if (bind()) return;
    lock.unlock();
    c.flush_block();
    lock.lock();
    bind();
}

}  // namespace

void UniformBlockBinding(Context& c, GLuint name, GLuint index, GLuint binding) {
    bind_block(c, name, index, binding, &Executable::blocks, glstate::el::uniform_buffer::count);
}

void ShaderStorageBlockBinding(Context& c, GLuint name, GLuint index, GLuint binding) {
    bind_block(c, name, index, binding, &Executable::storage_blocks, glstate::el::storage_buffer::count);
}

void GetActiveAtomicCounterBufferiv(Context& c, GLuint name, GLuint index, GLenum pname, GLint* params) {
    with_executable(c, name, [&](const Executable& executable) {
        if (index >= executable.counter_buffers.size()) return c.error(GL_INVALID_VALUE);
        const glapi::ActiveCounterBuffer& buffer = executable.counter_buffers[index];
        const auto active_in = [&](GLenum stage) { *params = is_active_in(buffer.stages, stage); };
        switch (pname) {
            case GL_ATOMIC_COUNTER_BUFFER_BINDING: *params = static_cast<GLint>(buffer.binding); break;
            case GL_ATOMIC_COUNTER_BUFFER_DATA_SIZE: *params = static_cast<GLint>(buffer.bytes); break;
            case GL_ATOMIC_COUNTER_BUFFER_ACTIVE_ATOMIC_COUNTERS:
                *params = 0;
                for_each_counter(executable, index, [&](GLint) { ++*params; });
                break;
            case GL_ATOMIC_COUNTER_BUFFER_ACTIVE_ATOMIC_COUNTER_INDICES:
                for_each_counter(executable, index, [&](GLint uniform) { *params++ = uniform; });
                break;
            case GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_VERTEX_SHADER: active_in(GL_VERTEX_SHADER); break;
            case GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_FRAGMENT_SHADER: active_in(GL_FRAGMENT_SHADER); break;
            case GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_GEOMETRY_SHADER: active_in(GL_GEOMETRY_SHADER); break;
            case GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_TESS_CONTROL_SHADER: active_in(GL_TESS_CONTROL_SHADER); break;
            case GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_TESS_EVALUATION_SHADER:
                active_in(GL_TESS_EVALUATION_SHADER);
                break;
            case GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_COMPUTE_SHADER: active_in(GL_COMPUTE_SHADER); break;
            default: c.error(GL_INVALID_ENUM);
        }
    });
}

void GetActiveUniformBlockiv(Context& c, GLuint name, GLuint index, GLenum pname, GLint* params) {
    with_block(c, name, index, [&](const Executable& executable, const UniformBlock& block) {
        const auto active_in = [&](GLenum stage) { *params = is_active_in(block.stages, stage); };
        switch (pname) {
            case GL_UNIFORM_BLOCK_BINDING: *params = static_cast<GLint>(block.binding); break;
            case GL_UNIFORM_BLOCK_DATA_SIZE: *params = static_cast<GLint>(block.bytes); break;
            case GL_UNIFORM_BLOCK_NAME_LENGTH: *params = static_cast<GLint>(block.name.size() + 1); break;
            case GL_UNIFORM_BLOCK_ACTIVE_UNIFORMS:
                *params = 0;
                for_each_member(executable.uniforms, executable.blocks, index, [&](GLint) { ++*params; });
                break;
            case GL_UNIFORM_BLOCK_ACTIVE_UNIFORM_INDICES:
                for_each_member(executable.uniforms, executable.blocks, index,
                                [&](GLint uniform) { *params++ = uniform; });
                break;
            case GL_UNIFORM_BLOCK_REFERENCED_BY_VERTEX_SHADER: active_in(GL_VERTEX_SHADER); break;
            case GL_UNIFORM_BLOCK_REFERENCED_BY_FRAGMENT_SHADER: active_in(GL_FRAGMENT_SHADER); break;
            case GL_UNIFORM_BLOCK_REFERENCED_BY_GEOMETRY_SHADER: active_in(GL_GEOMETRY_SHADER); break;
            case GL_UNIFORM_BLOCK_REFERENCED_BY_TESS_CONTROL_SHADER: active_in(GL_TESS_CONTROL_SHADER); break;
            case GL_UNIFORM_BLOCK_REFERENCED_BY_COMPUTE_SHADER: active_in(GL_COMPUTE_SHADER); break;
            case GL_UNIFORM_BLOCK_REFERENCED_BY_TESS_EVALUATION_SHADER: active_in(GL_TESS_EVALUATION_SHADER); break;
            default: c.error(GL_INVALID_ENUM);
        }
    });
}

void GetActiveUniformBlockName(Context& c, GLuint name, GLuint index, GLsizei room, GLsizei* length, GLchar* out) {
    with_block(c, name, index,
               [&](const Executable&, const UniformBlock& block) { give_text(c, block.name, room, length, out); });
}

void GetUniformIndices(Context& c, GLuint name, GLsizei count, const GLchar* const* names, GLuint* indices) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    with_executable(c, name, [&](const Executable& executable) {
        for (GLsizei i = 0; i < count; ++i)
            indices[i] = names[i] ? executable.uniform_index_of(names[i]).value_or(GL_INVALID_INDEX) : GL_INVALID_INDEX;
    });
}

void GetActiveUniformsiv(Context& c, GLuint name, GLsizei count, const GLuint* indices, GLenum pname, GLint* params) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    with_executable(c, name, [&](const Executable& executable) {
        for (GLsizei i = 0; i < count; ++i)
            if (indices[i] >= executable.uniforms.size()) return c.error(GL_INVALID_VALUE);
        for (GLsizei i = 0; i < count; ++i)
            if (!get_of_uniform(executable.uniforms[indices[i]], pname, params[i])) return c.error(GL_INVALID_ENUM);
    });
}

void GetActiveUniformName(Context& c, GLuint name, GLuint index, GLsizei room, GLsizei* length, GLchar* out) {
    with_executable(c, name, [&](const Executable& executable) {
        if (index >= executable.uniforms.size()) return c.error(GL_INVALID_VALUE);
        give_text(c, executable.uniforms[index].full_name(), room, length, out);
    });
}

}  // namespace wall::client::api
