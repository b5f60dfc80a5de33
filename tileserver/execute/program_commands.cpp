// SPDX-License-Identifier: MIT
#include "tileserver/execute/program_commands.h"

#include <string>
#include <utility>
#include <vector>

#include "common/glapi/assembly_format.h"
#include "common/log/log.h"
#include "tileserver/objects/assembly_build.h"
#include "tileserver/objects/program.h"
#include "tileserver/objects/program_build.h"

namespace wall::tileserver {

namespace {

/// A session that has so many shaders given up keeps others waiting for theirs.
constexpr int kMostGivenUp = 16;

}  // namespace

void ProgramCommands::hold(std::shared_ptr<const CompileTrial> trial,
                           std::function<void(const CompileTrial& trial)> then) {
    tried_ = Tried{std::move(trial), std::move(then)};
    go_on();
}

void ProgramCommands::go_on() {
    if (!tried_ || waits()) return;
    const Tried tried = *std::exchange(tried_, std::nullopt);
    tried.then(*tried.trial);
}

std::string ProgramCommands::given_up() {
    if (++given_up_ > kMostGivenUp) execution_.refuse("too many shaders that take the compiler too long");
    const std::string limits = execution_.node.trials->limits();
    log::warn("shader_given_up session={} limits={}", execution_.session.id().value, log::quoted(limits));
    return "error: given up: the compiler took more than " + limits + ", or crashed\n";
}

void ProgramCommands::ShaderCompile(RequestId request, GLenum type, std::span<const std::byte> source) {
    if (execution_.node.trials == nullptr) return compile(request, type, source);
    hold(execution_.node.trials->shader(type, source), [=, this](const CompileTrial& trial) {
        if (trial.outcome() == Outcome::unavailable || trial.answer().empty()) {
            if (trial.outcome() != Outcome::given_up) return compile(request, type, source);
            return execution_.output.reply(request, given_up_answer(type));
        }
        execution_.output.reply(request, std::vector(trial.answer()));
    });
}

std::vector<std::byte> ProgramCommands::given_up_answer(GLenum type) {
    const std::string reason = given_up();
    if (!glapi::assembly_stage(type)) return encode(glapi::CompileResult{false, reason});
    return encode(glapi::AssemblyReflection{.error_position = 0, .message = reason});
}

void ProgramCommands::when_tried(GLenum type, std::span<const std::byte> source, std::function<void()> then) {
    if (execution_.node.trials == nullptr) return then();
    hold(execution_.node.trials->shader(type, source), [this, then = std::move(then)](const CompileTrial& trial) {
        if (trial.outcome() == Outcome::given_up) given_up();
        else then();
    });
}

void ProgramCommands::compile(RequestId request, GLenum type, std::span<const std::byte> source) {
    if (const auto stage = glapi::assembly_stage(type)) {
        execution_.node.driver.edit_assembly(*stage, 0);
        return execution_.output.reply(request, compile_assembly(execution_.gl, *stage, source));
    }
    auto answer = compile_shader(execution_.gl, type, source);
    if (!answer) return execution_.refuse(answer.error().message);
    execution_.output.reply(request, std::move(*answer));
}

void ProgramCommands::ProgramLink(RequestId request, ClientName program, std::span<const std::byte> definition) {
    if (execution_.node.trials == nullptr) return link(request, program, definition);
    hold(execution_.node.trials->program(definition), [=, this](const CompileTrial& trial) {
        if (trial.outcome() == Outcome::unavailable) return link(request, program, definition);
        if (trial.outcome() == Outcome::done) {
            const auto found = glapi::decode_reflection(trial.answer()).value_or(glapi::ProgramReflection{});
            return link(request, program, definition, &found);
        }
        const std::string reason = given_up();
        if (request) execution_.output.reply(request, encode(glapi::ProgramReflection{false, reason}));
    });
}

void ProgramCommands::link(RequestId request, ClientName program, std::span<const std::byte> definition,
                           const glapi::ProgramReflection* recognised) {
    const auto made = execution_.session.objects.make<Program>(program, execution_.node.driver);
    if (!made) return execution_.refuse(made.error().message);
    auto answer = (*made)->link(definition, static_cast<bool>(request), recognised);
    if (!answer) return execution_.refuse(answer.error().message);
    if (request) execution_.output.reply(request, std::move(*answer));
}

void ProgramCommands::Uniform(ClientName program, std::uint32_t location, GLenum type, std::uint32_t count,
                              std::span<const std::byte> values) {
    const auto found = execution_.session.objects.get<Program>(program);
    if (!found) return execution_.refuse(found.error().message);
    if (auto done = (*found)->set_uniform(location, type, count, values); !done)
        execution_.refuse(done.error().message);
}

void ProgramCommands::UniformBlock(ClientName program, std::uint32_t block, std::uint32_t binding) {
    const auto found = execution_.session.objects.get<Program>(program);
    if (!found) return execution_.refuse(found.error().message);
    if (auto done = (*found)->bind_block(block, binding); !done) execution_.refuse(done.error().message);
}

void ProgramCommands::StorageBlock(ClientName program, std::uint32_t block, std::uint32_t binding) {
    const auto found = execution_.session.objects.get<Program>(program);
    if (!found) return execution_.refuse(found.error().message);
    if (auto done = (*found)->bind_storage_block(block, binding); !done) execution_.refuse(done.error().message);
}

void ProgramCommands::Subroutines(ClientName program, GLenum stage, std::span<const std::byte> indices) {
    const auto found = execution_.session.objects.get<Program>(program);
    if (!found) return execution_.refuse(found.error().message);
    if (auto done = (*found)->set_subroutines(stage, indices); !done) execution_.refuse(done.error().message);
}

}  // namespace wall::tileserver
