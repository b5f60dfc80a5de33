// SPDX-License-Identifier: MIT
#include "tileserver/execute/assembly_program_commands.h"

#include "common/glapi/assembly_format.h"
#include "tileserver/objects/assembly_program.h"

namespace wall::tileserver {

void AssemblyProgramCommands::AssemblyDefine(ClientName name, GLenum target, std::span<const std::byte> bytes) {
    const auto stage = glapi::assembly_stage(target);
    if (!stage) return execution_.refuse("no target of assembly programs");
    const auto definition = glapi::decode_assembly_definition(bytes);
    if (!definition) return execution_.refuse("bad definition of an assembly program");
    const auto made = execution_.session.objects.make<AssemblyProgram>(name, execution_.node.driver, *stage);
    if (!made) return execution_.refuse(made.error().message);
    if ((*made)->stage() != *stage) return execution_.refuse("an assembly program of another target");
    const auto source = std::as_bytes(std::span(definition->source));
    trials_.when_tried(target, source, [=, this] {
        if (auto done = (*made)->define(bytes); !done) execution_.refuse(done.error().message);
    });
}

void AssemblyProgramCommands::AssemblyLocals(ClientName name, std::uint32_t first, std::span<const std::byte> values) {
    const auto found = execution_.session.objects.get<AssemblyProgram>(name);
    if (!found) return execution_.refuse(found.error().message);
    if (auto done = (*found)->set_locals(first, values); !done) execution_.refuse(done.error().message);
}

}  // namespace wall::tileserver
