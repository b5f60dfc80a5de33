// SPDX-License-Identifier: MIT
// Parameters of assembly programs (GL_ARB_vertex_program, 2.14.1.1; GL_EXT_gpu_program_parameters): those of the
// environment are state of the context, the local ones the bound program's.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client_lib/context/assembly_binding.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;
using glapi::AssemblyStage;
using Parameter = AssemblyProgram::Parameter;

/// Whether there are so many from `first` on, of the environment or locally; else an error. `target` is one.
bool exist(Context& c, GLenum target, GLenum limit, GLuint first, GLsizei count) {
    GLint most = 0;
    GetProgramivARB(c, target, limit, &most);
    const std::uint64_t behind = std::uint64_t{first} + static_cast<std::uint64_t>(std::max(count, 0));
    if (count > 0 && behind <= static_cast<std::uint64_t>(most)) return true;
    c.error(GL_INVALID_VALUE);
    return false;
}

/// Nothing, and an error: no target, or no such parameters.
std::optional<AssemblyStage> check(Context& c, GLenum target, GLenum limit, GLuint first, GLsizei count) {
    const auto stage = glapi::assembly_stage(target);
    if (!stage) c.error(GL_INVALID_ENUM);
    return stage && exist(c, target, limit, first, count) ? stage : std::nullopt;
}

void set_environment(Context& c, AssemblyStage stage, GLuint index, const Parameter& value) {
    if (stage == AssemblyStage::vertex) c.set<el::vertex_env>(index, value);
    else c.set<el::fragment_env>(index, value);
}

void set_locals(Context& c, AssemblyStage stage, GLuint first, std::span<const Parameter> values) {
    const auto program = make_bound_assembly(c, stage);
    {
        std::lock_guard lock(c.share().mutex);
        if (program->holds(first, values)) return;
    }
    c.flush_block();
    std::lock_guard lock(c.share().mutex);
    program->set_locals(first, values);
    c.share().last_change = next_stamp();
}

Parameter parameter_at(const GLfloat* values) {
    Parameter out;
    std::copy_n(values, out.size(), out.begin());
    return out;
}

template <class Out>
void get_environment(Context& c, GLenum target, GLuint index, Out* out) {
    const auto stage = check(c, target, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, index, 1);
    if (!stage) return;
    const Parameter value =
        *stage == AssemblyStage::vertex ? c.get<el::vertex_env>(index) : c.get<el::fragment_env>(index);
    std::copy(value.begin(), value.end(), out);
}

template <class Out>
void get_local(Context& c, GLenum target, GLuint index, Out* out) {
    const auto stage = check(c, target, GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB, index, 1);
    if (!stage) return;
    std::lock_guard lock(c.share().mutex);
    const AssemblyProgram* program = bound_assembly(c, *stage);
    const Parameter value = program ? program->local(index) : Parameter{};
    std::copy(value.begin(), value.end(), out);
}

}  // namespace

void ProgramEnvParameter4fARB(Context& c, GLenum target, GLuint index, GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    if (const auto stage = check(c, target, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, index, 1))
        set_environment(c, *stage, index, {x, y, z, w});
}

void ProgramEnvParameters4fvEXT(Context& c, GLenum target, GLuint first, GLsizei count, const GLfloat* values) {
    const auto stage = check(c, target, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, first, count);
    if (!stage || !values) return;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i)
        set_environment(c, *stage, first + i, parameter_at(values + 4 * std::size_t{i}));
}

void ProgramLocalParameter4fARB(Context& c, GLenum target, GLuint index, GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    const Parameter value{x, y, z, w};
    if (const auto stage = check(c, target, GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB, index, 1))
        set_locals(c, *stage, index, {&value, 1});
}

void ProgramLocalParameters4fvEXT(Context& c, GLenum target, GLuint first, GLsizei count, const GLfloat* values) {
    const auto stage = check(c, target, GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB, first, count);
    if (!stage || !values) return;
    std::vector<Parameter> parameters;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        parameters.push_back(parameter_at(values + 4 * i));
    set_locals(c, *stage, first, parameters);
}

void GetProgramEnvParameterfvARB(Context& c, GLenum target, GLuint index, GLfloat* params) {
    get_environment(c, target, index, params);
}
void GetProgramEnvParameterdvARB(Context& c, GLenum target, GLuint index, GLdouble* params) {
    get_environment(c, target, index, params);
}
void GetProgramLocalParameterfvARB(Context& c, GLenum target, GLuint index, GLfloat* params) {
    get_local(c, target, index, params);
}
void GetProgramLocalParameterdvARB(Context& c, GLenum target, GLuint index, GLdouble* params) {
    get_local(c, target, index, params);
}

}  // namespace wall::client::api
