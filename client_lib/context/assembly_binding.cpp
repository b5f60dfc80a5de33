// SPDX-License-Identifier: MIT
#include "client_lib/context/assembly_binding.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "client_lib/context/compiler_questions.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

namespace el = glstate::el;
using glapi::AssemblyStage;
using glapi::index_of;

/// The state names it.
void set_bound_id(Context& c, AssemblyStage stage, ClientName id) {
    if (stage == AssemblyStage::vertex) c.set<el::vertex_program>(0, id.value);
    else c.set<el::fragment_program>(0, id.value);
}

}  // namespace

AssemblyProgram* bound_assembly(const Context& c, AssemblyStage stage) { return c.assembly->program(c.share(), stage); }

std::shared_ptr<AssemblyProgram> make_bound_assembly(Context& c, AssemblyStage stage) {
    if (const auto& bound = c.assembly->bound[index_of(stage)]) return bound;
    std::lock_guard lock(c.share().mutex);
    auto& program = c.share().default_assembly_programs[index_of(stage)];
    if (!program) {
        program = std::make_shared<AssemblyProgram>(0, stage);
        c.share().by_id[program->id] = program;
    }
    return program;
}

void bind_assembly(Context& c, AssemblyStage stage, std::shared_ptr<AssemblyProgram> program) {
    ClientName id;
    {
        std::lock_guard lock(c.share().mutex);
        const auto& otherwise = c.share().default_assembly_programs[index_of(stage)];
        if (program && std::ranges::count(program->bound_by, c.id) == 0) program->bound_by.push_back(c.id);
        if (program || otherwise) id = (program ? program : otherwise)->id;
    }
    set_bound_id(c, stage, id);
    c.assembly->bound[index_of(stage)] = std::move(program);
}

void forget_assembly(Context& c, const std::shared_ptr<AssemblyProgram>& program) {
    if (c.assembly->bound[index_of(program->stage)] == program) bind_assembly(c, program->stage, nullptr);
    const auto& users = program->bound_by;
    if (!users.empty() && (users.size() > 1 || users[0] != c.id)) return;  // another context may still draw with it
    c.forget_object(program->id);
    std::lock_guard lock(c.share().mutex);
    c.share().by_id.erase(program->id);
}

bool draws_with_assembly(const Context& c, AssemblyStage stage) {
    return draws_with_assembly(c.state, c.program.get(), stage);
}

bool may_use_assembly(const Context& c, AssemblyStage stage) {
    if (!enables_assembly(c.state, stage)) return true;
    std::lock_guard lock(c.share().mutex);
    if (!draws_with_assembly(c, stage)) return true;
    const AssemblyProgram* program = bound_assembly(c, stage);
    return program && program->loaded();
}

std::optional<glapi::AssemblyReflection> learn_assembly(Context& c, AssemblyStage stage, const std::string& source) {
    const GLenum target = glapi::target_of(stage);
    const auto bytes = std::as_bytes(std::span(source));
    glapi::ContentHash hash = compiler_question(c);
    hash.ShaderCompile(target, bytes);
    const auto name = hash.finish();
    const auto known = kept_answers().find(name);
    auto reflection = known ? glapi::decode_assembly_reflection(*known) : std::nullopt;
    if (reflection) return reflection;
    const auto answer = ask_compiler(c, "glProgramStringARB", [&](wire::PackBuffer& buffer, RequestId request) {
        glapi::pack::ShaderCompile(buffer, request, target, bytes);
    });
    reflection = answer ? glapi::decode_assembly_reflection(answer->bytes) : std::nullopt;
    if (reflection && reflection->compiled) kept_answers().keep(name, answer->bytes);
    return reflection;
}

bool is_assembly_word(GLenum word) {
    switch (word) {
        case GL_VERTEX_PROGRAM_ARB:
        case GL_FRAGMENT_PROGRAM_ARB:
        case GL_PROGRAM_ERROR_POSITION_ARB:
        case GL_CURRENT_MATRIX_ARB:
        case GL_TRANSPOSE_CURRENT_MATRIX_ARB:
        case GL_CURRENT_MATRIX_STACK_DEPTH_ARB:
        case GL_MAX_PROGRAM_MATRICES_ARB:
        case GL_MAX_PROGRAM_MATRIX_STACK_DEPTH_ARB: return true;
        default: return false;
    }
}

bool is_assembly_limit(GLenum word) {
    const auto among = [&](const auto& words) {
        return std::ranges::find(words, word, &glapi::AssemblyWord::most) != std::end(words);
    };
    return among(glapi::kAssemblyWords) || among(glapi::kAssemblyParameters);
}

}  // namespace wall::client
