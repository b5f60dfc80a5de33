// SPDX-License-Identifier: MIT
// Separable programs and the pipelines that are made of them (OpenGL 4.1, 2.14.4).
#include "client_lib/objects/program_pipeline.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "client_lib/api/program_access.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/let_go.h"
#include "client_lib/context/program_use.h"

namespace wall::client::api {
namespace {

/// In the order of glapi::kShaderStages.
constexpr GLbitfield kBits[] = {GL_VERTEX_SHADER_BIT,       GL_FRAGMENT_SHADER_BIT,        GL_GEOMETRY_SHADER_BIT,
                                GL_TESS_CONTROL_SHADER_BIT, GL_TESS_EVALUATION_SHADER_BIT, GL_COMPUTE_SHADER_BIT};
static_assert(std::size(kBits) == ProgramPipeline::kStages);

bool are_stages(GLbitfield bits) {
    if (bits == GL_ALL_SHADER_BITS) return true;
    for (const GLbitfield bit : kBits) bits &= ~bit;
    return bits == 0;
}

/// Made if the name was only reserved. Null, and an error: there is none of that name.
std::shared_ptr<ProgramPipeline> pipeline_of(Context& c, GLuint name) {
    auto& names = c.pipelines->names;
    if (name == 0 || !names.known(name)) return c.error(GL_INVALID_OPERATION), nullptr;
    auto found = names.find(name);
    if (found) return found;
    names.put(name, found = std::make_shared<ProgramPipeline>(name, c.profile.is_es()));
    std::lock_guard lock(c.share().mutex);
    c.share().by_id[found->id] = found;
    return found;
}

/// The pipeline uses a program in place of another for a stage; either may be null. The caller drops what is returned.
std::shared_ptr<Program> exchange_program(ProgramPipeline& pipeline, std::size_t stage,
                                          std::shared_ptr<Program> program) {
    if (program) ++program->users;
    return std::exchange(pipeline.programs[stage], std::move(program));
}

/// Of which the pipeline is to have `stages`; those that the program lacks it has from nobody then.
void set_programs(Context& c, ProgramPipeline& pipeline, GLbitfield stages, const std::shared_ptr<Program>& program) {
    c.flush_block();
    std::vector<std::shared_ptr<Program>> dropped;
    {
        std::lock_guard lock(c.share().mutex);
        for (std::size_t i = 0; i < std::size(kBits); ++i) {
            if ((stages & kBits[i]) == 0) continue;
            const bool has = program && (program->executable->stages >> i & 1) != 0;
            dropped.push_back(exchange_program(pipeline, i, has ? program : nullptr));
        }
        pipeline.validated = false;
        pipeline.combine();
        c.share().last_change = pipeline.executable->stamp;
    }
    c.before_change(pipeline.id);
    for (const auto& before : dropped)
        if (before) drop_user(c, before);
}

/// Bound pipelines are drawn with while no program is in use.
void bind(Context& c, std::shared_ptr<ProgramPipeline> pipeline) {
    if (pipeline && pipeline->is_outdated()) {
        std::lock_guard lock(c.share().mutex);
        pipeline->combine();
    }
    c.pipelines->bound = std::move(pipeline);
    if (!c.pipelines->used) use_program(c, c.pipelines->bound);
}

/// Why it is not valid (OpenGL 4.5, 11.1.3.11), for its info log; empty: it is.
std::string fault_of(const ProgramPipeline& pipeline) {
    if (!pipeline.fault().empty()) return "error: " + pipeline.fault() + "\n";
    if (pipeline.executable->parts.empty()) return "error: there is no program\n";
    if (!pipeline.executable->samplers_conflict()) return {};
    return "error: samplers of different types name one texture unit\n";
}

GLint name_of(const std::shared_ptr<Program>& program) { return program ? static_cast<GLint>(program->name) : 0; }

}  // namespace

GLuint CreateShaderProgramv(Context& c, GLenum type, GLsizei count, const GLchar* const* strings) {
    if (count < 0) return c.error(GL_INVALID_VALUE), 0;
    const GLuint shader = CreateShader(c, type);
    if (shader == 0) return 0;
    ShaderSource(c, shader, count, strings, nullptr);
    CompileShader(c, shader);
    const GLuint name = CreateProgram(c);
    GLint compiled = 0;
    GetShaderiv(c, shader, GL_COMPILE_STATUS, &compiled);
    const auto program = program_of(c, name);
    const auto made = shader_of(c, shader);
    if (!program || !made) return name;
    program->separable = true;
    if (compiled) {
        AttachShader(c, name, shader);
        LinkProgram(c, name);
        DetachShader(c, name, shader);
    } else {
        std::lock_guard lock(c.share().mutex);
        program->log = made->log;
    }
    DeleteShader(c, shader);
    return name;
}

void GenProgramPipelines(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const GLuint first = c.pipelines->names.reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteProgramPipelines(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    for (GLsizei i = 0; i < count; ++i) {
        if (names[i] == 0) continue;
        const auto pipeline = c.pipelines->names.erase(names[i]);
        if (!pipeline) continue;
        if (c.pipelines->bound == pipeline) bind(c, nullptr);
        c.flush_block();
        forget_pipeline(c, *pipeline);
    }
}

GLboolean IsProgramPipeline(Context& c, GLuint name) { return name != 0 && c.pipelines->names.find(name) != nullptr; }

void BindProgramPipeline(Context& c, GLuint name) {
    if (c.captures->captures()) return c.error(GL_INVALID_OPERATION);
    if (name == 0) return bind(c, nullptr);
    if (auto pipeline = pipeline_of(c, name)) bind(c, std::move(pipeline));
}

void UseProgramStages(Context& c, GLuint name, GLbitfield stages, GLuint program_name) {
    if (!are_stages(stages)) return c.error(GL_INVALID_VALUE);
    const auto pipeline = pipeline_of(c, name);
    if (!pipeline) return;
    if (pipeline == c.pipelines->bound && c.captures->captures()) return c.error(GL_INVALID_OPERATION);
    std::shared_ptr<Program> program;
    if (program_name != 0) {
        program = linked_program(c, program_name);
        if (!program) return;
        if (!program->linked || !program->linked_separable) return c.error(GL_INVALID_OPERATION);
    }
    set_programs(c, *pipeline, stages, program);
}

void ActiveShaderProgram(Context& c, GLuint name, GLuint program_name) {
    const auto pipeline = pipeline_of(c, name);
    if (!pipeline) return;
    std::shared_ptr<Program> program;
    if (program_name != 0) {
        program = linked_program(c, program_name);
        if (!program) return;
        if (!program->linked) return c.error(GL_INVALID_OPERATION);
    }
    pipeline->active = std::move(program);
}

void ValidateProgramPipeline(Context& c, GLuint name) {
    const auto pipeline = pipeline_of(c, name);
    if (!pipeline) return;
    std::lock_guard lock(c.share().mutex);
    if (pipeline->is_outdated()) pipeline->combine();
    pipeline->log = fault_of(*pipeline);
    pipeline->validated = pipeline->log.empty();
}

void GetProgramPipelineiv(Context& c, GLuint name, GLenum pname, GLint* params) {
    const auto pipeline = pipeline_of(c, name);
    if (!pipeline) return;
    const auto* stage = std::ranges::find(glapi::kShaderStages, pname);
    if (stage != std::end(glapi::kShaderStages)) {
        *params = name_of(pipeline->programs[static_cast<std::size_t>(stage - std::begin(glapi::kShaderStages))]);
        return;
    }
    switch (pname) {
        case GL_ACTIVE_PROGRAM: *params = name_of(pipeline->active); break;
        case GL_VALIDATE_STATUS: *params = pipeline->validated; break;
        case GL_INFO_LOG_LENGTH:
            *params = pipeline->log.empty() ? 0 : static_cast<GLint>(pipeline->log.size() + 1);
            break;
        default: c.error(GL_INVALID_ENUM);
    }
}

void GetProgramPipelineInfoLog(Context& c, GLuint name, GLsizei room, GLsizei* length, GLchar* out) {
    const auto& names = c.pipelines->names;
    if (name == 0 || !names.known(name)) return c.error(GL_INVALID_VALUE);
    const auto pipeline = names.find(name);
    give_text(c, pipeline ? pipeline->log : std::string(), room, length, out);
}

}  // namespace wall::client::api
