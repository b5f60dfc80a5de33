// SPDX-License-Identifier: MIT
#include "tileserver/execute/program_commands.h"

#include <utility>

#include "tileserver/objects/program.h"
#include "tileserver/objects/program_build.h"

namespace wall::tileserver {

void ProgramCommands::ShaderCompile(RequestId request, GLenum type, std::span<const std::byte> source) {
    auto answer = compile_shader(execution_.gl, type, source);
    if (!answer) return execution_.refuse(answer.error().message);
    execution_.output.reply(request, std::move(*answer));
}

void ProgramCommands::ProgramLink(RequestId request, ClientName program, std::span<const std::byte> definition) {
    const auto made = execution_.session.objects.make<Program>(program, execution_.node.driver);
    if (!made) return execution_.refuse(made.error().message);
    auto answer = (*made)->link(definition, static_cast<bool>(request));
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
