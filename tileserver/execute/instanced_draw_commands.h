// SPDX-License-Identifier: MIT
// Group [instanced_draw]: draws from buffers that are made several times, or in which primitives begin anew. Render
// thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/array_draw_commands.h"

namespace wall::tileserver {

class InstancedDrawCommands {
public:
    /// Both outlive it.
    InstancedDrawCommands(Execution& execution, ArrayDrawCommands& draws) : execution_(execution), draws_(draws) {}

    void DrawArraysInstanced(ClientName input, GLenum mode, std::int32_t first, std::int32_t count,
                             std::int32_t instances);
    void DrawElementsInstanced(ClientName input, GLenum mode, std::int32_t count, GLenum type, std::uint32_t offset,
                               std::int32_t base_vertex, std::int32_t instances, std::uint32_t restart,
                               std::uint32_t restart_index);
    void DrawIndicesInstanced(ClientName input, GLenum mode, GLenum type, std::int32_t base_vertex,
                              std::int32_t instances, std::uint32_t restart, std::uint32_t restart_index,
                              std::span<const std::byte> indices);

    /// The checks that draws of several instances have in common. Null: nothing is to be drawn, perhaps because it was
    /// refused.
    VertexInput* begin(ClientName input, GLenum mode, std::int32_t count, std::int32_t instances);

private:
    Execution& execution_;
    ArrayDrawCommands& draws_;
};

}  // namespace wall::tileserver
