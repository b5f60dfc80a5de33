// SPDX-License-Identifier: MIT
// Group [assembly]: programs of GL_ARB_vertex_program and GL_ARB_fragment_program. Their text is tried before the
// node's driver gets it, as that of shaders is (program_commands.h). Render thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"
#include "tileserver/execute/program_commands.h"

namespace wall::tileserver {

class AssemblyProgramCommands {
public:
    /// Both outlive it; at `trials` the stream waits for a trial.
    AssemblyProgramCommands(Execution& execution, ProgramCommands& trials) : execution_(execution), trials_(trials) {}

    void AssemblyDefine(ClientName program, GLenum target, std::span<const std::byte> definition);
    void AssemblyLocals(ClientName program, std::uint32_t first, std::span<const std::byte> values);

private:
    Execution& execution_;
    ProgramCommands& trials_;
};

}  // namespace wall::tileserver
