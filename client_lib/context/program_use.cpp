// SPDX-License-Identifier: MIT
#include "client_lib/context/program_use.h"

#include <algorithm>
#include <iterator>
#include <ranges>
#include <utility>

#include "client_lib/context/assembly_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/compiler_questions.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/indexed_buffers.h"
#include "client_lib/objects/blend_support.h"
#include "client_lib/objects/program_pipeline.h"
#include "client_lib/process/log.h"
#include "common/glapi/primitive.h"

namespace wall::client {
namespace {

constexpr const char* kNoAnswer = "no node of the wall answered\n";

void take_link_result(Program& program, glapi::ProgramDefinition definition, glapi::ProgramReflection reflection) {
    program.log = std::move(reflection.log);
    program.linked = reflection.linked;
    if (!reflection.linked) return;
    const bool separable = definition.separable;
    auto executable = Executable::make(std::move(definition), std::move(reflection));
    program.linked = executable != nullptr;
    if (executable) program.linked_separable = separable;
    if (executable) program.executable = std::move(executable);
    else program.log = "the program has a uniform of a type that is not supported\n";
}

}  // namespace

void learn_compile_result(Context& c, Shader& shader) {
    std::string source;
    {
        std::lock_guard lock(c.share().mutex);
        if (shader.state != Shader::State::unknown) return;
        source = shader.compiled_source;
    }
    const auto bytes = std::as_bytes(std::span(source));
    glapi::ContentHash hash = compiler_question(c);
    hash.ShaderCompile(shader.type, bytes);
    const auto name = hash.finish();
    const auto known = kept_answers().find(name);
    auto result = known ? glapi::decode_compile_result(*known) : std::nullopt;
    if (!result) {
        const auto answer = ask_compiler(c, "glCompileShader", [&](wire::PackBuffer& buffer, RequestId request) {
            glapi::pack::ShaderCompile(buffer, request, shader.type, bytes);
        });
        result = answer ? glapi::decode_compile_result(answer->bytes) : std::nullopt;
        // A failure may be one of this moment: a compiler that was given up.
        if (result && result->compiled) kept_answers().keep(name, answer->bytes);
    }
    std::lock_guard lock(c.share().mutex);
    shader.state = result && result->compiled ? Shader::State::compiled : Shader::State::failed;
    shader.log = result ? std::move(result->log) : kNoAnswer;
}

void learn_link_result(Context& c, Program& program) {
    std::optional<glapi::ProgramDefinition> definition;
    {
        std::lock_guard lock(c.share().mutex);
        definition = std::exchange(program.to_link, std::nullopt);
    }
    if (!definition) return;
    const auto bytes = encode(*definition);
    c.before_change(program.id);
    glapi::ContentHash hash = compiler_question(c);
    hash.ProgramLink(bytes);
    const auto name = hash.finish();
    const auto known = kept_answers().find(name);
    auto reflection = known ? glapi::decode_reflection(*known) : std::nullopt;
    std::optional<NodeAnswer> answer;
    if (!reflection) {
        answer = ask_compiler(c, "glLinkProgram", [&](wire::PackBuffer& buffer, RequestId request) {
            glapi::pack::ProgramLink(buffer, request, program.id, bytes);
        });
        reflection = answer ? glapi::decode_reflection(answer->bytes) : std::nullopt;
        if (reflection && reflection->linked) kept_answers().keep(name, answer->bytes);
    }
    std::scoped_lock lock(c.session().mutex(), c.share().mutex);
    if (!reflection) reflection.emplace().log = kNoAnswer;
    take_link_result(program, std::move(*definition), std::move(*reflection));
    if (program.linked && answer) answer->node->object_stamps[program.id] = program.executable->stamp;
    if (c.pipelines->bound && c.pipelines->bound->is_outdated()) c.pipelines->bound->combine();
    c.share().last_change = next_stamp();
}

void use_program(Context& c, std::shared_ptr<Program> program) {
    c.flush_block();
    {
        std::lock_guard lock(c.share().mutex);
        if (program) {
            ++program->users;
            program->executable->reset_subroutines();
        }
    }
    c.set<glstate::el::current_program>(0, program ? program->id.value : 0);
    if (const auto before = std::exchange(c.program, std::move(program))) drop_user(c, before);
}

bool reads_numbers(const Context& c) {
    if (!c.program) return false;
    std::lock_guard lock(c.share().mutex);
    return c.program->executable->reads_numbers();
}

std::uint32_t constant_doubles(const Context& c) {
    std::uint32_t doubles = c.program ? c.program->executable->double_attributes() : 0;
    for (unsigned i = 0; doubles != 0 && i < kVertexAttributes; ++i)
        if (c.get<glstate::el::attrib_array>(i).enabled) doubles &= ~(1u << i);
    return doubles;
}

namespace {

/// Whether single primitives of a kind go through the shaders; `single` is what comes out.
bool go_through(const Executable& executable, GLenum& single) {
    const glapi::TessellationStage& tessellation = executable.tessellation;
    const glapi::GeometryStage& geometry = executable.geometry;
    if ((single == GL_PATCHES) != tessellation.exists()) return false;
    if (tessellation.exists()) single = tessellation.output();
    if (!geometry.exists()) return true;
    return std::exchange(single, glapi::single_primitive(geometry.output)) == geometry.input;
}

}  // namespace

bool fits_program(Context& c, GLenum mode) {
    GLenum single = glapi::single_primitive(mode);
    bool fits = single != GL_PATCHES;
    if (c.program) {
        std::lock_guard lock(c.share().mutex);
        fits = go_through(*c.program->executable, single);
    }
    if (const Capture* capture = c.captures->captures()) fits = fits && single == capture->mode();
    if (!fits) c.error(GL_INVALID_OPERATION);
    return fits;
}

bool may_run(const Context& c) {
    if (!c.program) return true;
    const auto& pipeline = c.pipelines->bound;
    if (c.program == pipeline && !pipeline->fault().empty()) return false;
    return !c.program->executable->samplers_conflict();
}

namespace {

/// An advanced equation wants one colour alone, and a fragment shader that says that it goes with it
/// (GL_KHR_blend_equation_advanced; OpenGL ES 3.2, 15.1.5.1).
bool may_blend(const Context& c) {
    const auto& state = c.state.color_buffer;
    const std::uint32_t bit = state.blend_enabled == 0 ? 0 : advanced_equation_bit(state.blend_equation.rgb);
    if (bit == 0) return true;
    const auto& framebuffer = c.framebuffers->draw;
    const bool single = framebuffer ? std::ranges::count(framebuffer->draw_buffers() | std::views::drop(1), GL_NONE) ==
                                          std::ssize(framebuffer->draw_buffers()) - 1
                                    : c.get<glstate::el::draw_buffer>() != GL_FRONT_AND_BACK;
    if (!single || !c.program) return false;
    std::lock_guard lock(c.share().mutex);
    return (c.program->executable->blend_support & bit) != 0;
}

}  // namespace

bool may_draw(Context& c) {
    if ((c.framebuffers->draw || c.has_no_surface()) && !may_draw_to_target(c)) return false;
    if (!may_blend(c) || !may_use_assembly(c)) return c.error(GL_INVALID_OPERATION), false;
    if (!c.program) return true;
    find_written_to_read(c);
    c.before_writing_draw();
    std::lock_guard lock(c.share().mutex);
    if (may_run(c)) return true;
    c.error(GL_INVALID_OPERATION);
    return false;
}

namespace {

/// Frees the name; the nodes are told of a program.
void destroy(Context& c, const std::shared_ptr<GlslObject>& object) {
    c.before_change(object->id);
    std::vector<std::shared_ptr<Shader>> shaders;
    {
        std::lock_guard lock(c.share().mutex);
        c.share().glsl_objects.erase(object->name);
        if (object->kind == GlslObject::Kind::shader) return;
        c.share().by_id.erase(object->id);
        shaders = std::exchange(static_cast<Program&>(*object).shaders, {});
    }
    for (const auto& shader : shaders) drop_user(c, shader);
    c.session().delete_object(c.id, object->id);
}

}  // namespace

void drop_user(Context& c, const std::shared_ptr<GlslObject>& object) {
    bool last = false;
    {
        std::lock_guard lock(c.share().mutex);
        last = --object->users == 0 && object->deleted;
    }
    if (last) destroy(c, object);
}

void delete_object(Context& c, const std::shared_ptr<GlslObject>& object) {
    {
        std::lock_guard lock(c.share().mutex);
        if (std::exchange(object->deleted, true) || object->users != 0) return;
    }
    destroy(c, object);
}

}  // namespace wall::client
