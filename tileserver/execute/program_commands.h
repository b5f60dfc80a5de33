// SPDX-License-Identifier: MIT
// Groups [program] and [subroutine]: GLSL. Render thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class ProgramCommands {
public:
    /// `execution` outlives it.
    explicit ProgramCommands(Execution& execution) : execution_(execution) {}

    void ShaderCompile(RequestId request, GLenum type, std::span<const std::byte> source);
    void ProgramLink(RequestId request, ClientName program, std::span<const std::byte> definition);
    void UniformBlock(ClientName program, std::uint32_t block, std::uint32_t binding);
    void Uniform(ClientName program, std::uint32_t location, GLenum type, std::uint32_t count,
                 std::span<const std::byte> values);
    void StorageBlock(ClientName program, std::uint32_t block, std::uint32_t binding);
    void Subroutines(ClientName program, GLenum stage, std::span<const std::byte> indices);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
