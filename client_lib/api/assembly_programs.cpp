// SPDX-License-Identifier: MIT
// Assembly programs: their names and strings (GL_ARB_vertex_program, 2.14.1 and 6.1.12). One node is asked whether a
// string compiles; all queries are answered from the shadow. The programs of both targets have one space of names.
#include <algorithm>
#include <cstring>
#include <iterator>
#include <optional>

#include "client_lib/context/assembly_binding.h"
#include "client_lib/context/limits.h"
#include "client_lib/objects/share_group.h"
#include "common/glapi/recorder.h"

namespace wall::client {
namespace {

using glapi::AssemblyStage;

/// Nothing, and an error: it is no target.
std::optional<AssemblyStage> stage_of(Context& c, GLenum target) {
    const auto stage = glapi::assembly_stage(target);
    if (!stage) c.error(GL_INVALID_ENUM);
    return stage;
}

/// The program of that name, which is made if there is none. Null, and an error: it is one of the other target.
std::shared_ptr<AssemblyProgram> named_program(Context& c, AssemblyStage stage, GLuint name) {
    std::shared_ptr<AssemblyProgram> program;
    {
        ShareGroup& share = c.share();
        std::lock_guard lock(share.mutex);
        program = share.assembly_programs.find(name);
        if (!program) {
            program = std::make_shared<AssemblyProgram>(name, stage);
            share.assembly_programs.put(name, program);
            share.by_id[program->id] = program;
        }
    }
    if (program->stage == stage) return program;
    return c.error(GL_INVALID_OPERATION), nullptr;
}

/// How much of something there may be.
GLint limit(Context& c, AssemblyStage stage, const glapi::AssemblyWord& word) {
    const std::size_t place = glapi::index_of(stage);
    double most = limit_of(c.caps(), word.most, word.least(stage), place);
    constexpr double kEnvironment[] = {glstate::el::vertex_env::count, glstate::el::fragment_env::count};
    if (word.most == GL_MAX_PROGRAM_ENV_PARAMETERS_ARB) most = std::min(most, kEnvironment[place]);
    if (word.most == GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB) most = std::min<double>(most, glapi::kMostLocalParameters);
    return static_cast<GLint>(most);
}

/// What is counted in strings, and the limits. Nothing: no such word, or not of the stage.
std::optional<GLint> counted(Context& c, AssemblyStage stage, const AssemblyProgram* program, GLenum pname) {
    for (const glapi::AssemblyWord& word : glapi::kAssemblyParameters)
        if (pname == word.most) return limit(c, stage, word);
    for (std::size_t i = 0; i < std::size(glapi::kAssemblyWords); ++i) {
        const glapi::AssemblyWord& word = glapi::kAssemblyWords[i];
        if (!word.of(stage)) continue;
        if (pname == word.most) return limit(c, stage, word);
        if (pname == word.count)
            return program && program->loaded() ? static_cast<GLint>(program->reflection().counts[i]) : 0;
    }
    return std::nullopt;
}

}  // namespace

namespace api {

void GenProgramsARB(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    if (count == 0 || !names) return;
    std::lock_guard lock(c.share().mutex);
    const GLuint first = c.share().assembly_programs.reserve(static_cast<GLuint>(count));
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) names[i] = first + i;
}

void DeleteProgramsARB(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    c.flush_block();
    for (GLsizei i = 0; i < count; ++i) {
        if (names[i] == 0) continue;
        std::shared_ptr<AssemblyProgram> program;
        {
            std::lock_guard lock(c.share().mutex);
            program = c.share().assembly_programs.erase(names[i]);
        }
        if (program) forget_assembly(c, program);
    }
}

GLboolean IsProgramARB(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().assembly_programs.find(name) != nullptr;
}

void BindProgramARB(Context& c, GLenum target, GLuint name) {
    const auto stage = stage_of(c, target);
    if (!stage) return;
    if (name == 0) return bind_assembly(c, *stage, nullptr);
    if (auto program = named_program(c, *stage, name)) bind_assembly(c, *stage, std::move(program));
}

void ProgramStringARB(Context& c, GLenum target, GLenum format, GLsizei length, const void* string) {
    const auto stage = stage_of(c, target);
    if (!stage) return;
    if (format != GL_PROGRAM_FORMAT_ASCII_ARB) return c.error(GL_INVALID_ENUM);
    if (length < 0 || !string) return c.error(GL_INVALID_VALUE);
    c.flush_block();
    std::string source(static_cast<const char*>(string), static_cast<std::size_t>(length));
    auto reflection = learn_assembly(c, *stage, source);
    c.assembly->error_position = reflection ? reflection->error_position : 0;
    c.assembly->message = reflection ? reflection->message : "no node of the wall answered";
    if (!reflection || !reflection->compiled) return c.error(GL_INVALID_OPERATION);
    const auto program = make_bound_assembly(c, *stage);
    c.before_change(program->id);
    std::lock_guard lock(c.share().mutex);
    program->load(std::move(source), *std::move(reflection));
    c.share().last_change = program->latest();
}

void GetProgramivARB(Context& c, GLenum target, GLenum pname, GLint* params) {
    const auto stage = stage_of(c, target);
    if (!stage) return;
    std::lock_guard lock(c.share().mutex);
    const AssemblyProgram* program = bound_assembly(c, *stage);
    if (const auto value = counted(c, *stage, program, pname)) {
        *params = *value;
        return;
    }
    switch (pname) {
        case GL_PROGRAM_LENGTH_ARB: *params = program ? static_cast<GLint>(program->source().size()) : 0; break;
        case GL_PROGRAM_FORMAT_ARB: *params = GL_PROGRAM_FORMAT_ASCII_ARB; break;
        case GL_PROGRAM_BINDING_ARB: *params = program ? static_cast<GLint>(program->name) : 0; break;
        case GL_PROGRAM_UNDER_NATIVE_LIMITS_ARB:
            *params = !program || !program->loaded() || program->reflection().native;
            break;
        default: c.error(GL_INVALID_ENUM);
    }
}

void GetProgramStringARB(Context& c, GLenum target, GLenum pname, void* string) {
    const auto stage = stage_of(c, target);
    if (!stage) return;
    if (pname != GL_PROGRAM_STRING_ARB) return c.error(GL_INVALID_ENUM);
    std::lock_guard lock(c.share().mutex);
    const AssemblyProgram* program = bound_assembly(c, *stage);
    if (program) std::memcpy(string, program->source().data(), program->source().size());
}

}  // namespace api

// ---- in display lists ----

namespace compile {

void ProgramStringARB(Context& c, GLenum target, GLenum format, GLsizei length, const void* string) {
    c.list().record(static_cast<std::uint16_t>(CommandId::ProgramStringARB), target, format, length,
                    glapi::recorded_array(static_cast<const GLubyte*>(string), length));
    if (c.list().execute) execution_table(c).ProgramStringARB(c, target, format, length, string);
}

}  // namespace compile

namespace replay {

void ProgramStringARB(Context& c, std::span<const std::byte> payload) {
    glapi::RecordReader in(payload);
    const auto target = in.get<GLenum>(), format = in.get<GLenum>();
    const auto length = in.get<GLsizei>();
    execution_table(c).ProgramStringARB(c, target, format, length, in.array<GLubyte>());
}

}  // namespace replay
}  // namespace wall::client
