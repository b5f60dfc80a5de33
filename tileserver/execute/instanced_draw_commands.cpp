// SPDX-License-Identifier: MIT
#include "tileserver/execute/instanced_draw_commands.h"

#include <algorithm>
#include <limits>

#include "common/wire/limits.h"

namespace wall::tileserver {
namespace {

/// While it lives, primitives begin anew at an index. No other draw knows of it.
class Restart {
public:
    Restart(const Gl& gl, std::uint32_t on, std::uint32_t index) : gl_(gl), on_(on != 0) {
        if (!on_) return;
        gl_.PrimitiveRestartIndex(index);
        gl_.Enable(GL_PRIMITIVE_RESTART);
    }
    ~Restart() {
        if (on_) gl_.Disable(GL_PRIMITIVE_RESTART);
    }
    Restart(const Restart&) = delete;

private:
    const Gl& gl_;
    const bool on_;
};

}  // namespace

VertexInput* InstancedDrawCommands::begin(ClientName input, GLenum mode, std::int32_t count, std::int32_t instances) {
    if (instances < 0) return execution_.refuse("fewer than no instances"), nullptr;
    if (count > 0 &&
        static_cast<std::uint64_t>(count) * static_cast<std::uint64_t>(instances) > wire::kMostInstancedElements)
        return execution_.refuse("more elements than a draw may have"), nullptr;
    VertexInput* found = instances != 0 ? draws_.begin(input, mode, count) : nullptr;
    if (found != nullptr)
        draws_.count_elements(static_cast<std::uint64_t>(count) * static_cast<std::uint64_t>(instances));
    return found;
}

void InstancedDrawCommands::DrawArraysInstanced(ClientName name, GLenum mode, std::int32_t first, std::int32_t count,
                                                std::int32_t instances) {
    VertexInput* input = begin(name, mode, count, instances);
    if (input != nullptr && draws_.has_elements(*input, first, count))
        execution_.gl.DrawArraysInstanced(mode, first, count, instances);
}

void InstancedDrawCommands::DrawElementsInstanced(ClientName name, GLenum mode, std::int32_t count, GLenum type,
                                                  std::uint32_t offset, std::int32_t base_vertex,
                                                  std::int32_t instances, std::uint32_t restart,
                                                  std::uint32_t restart_index) {
    VertexInput* input = begin(name, mode, count, instances);
    if (input == nullptr || !draws_.has_indices(*input, count, type, offset)) return;
    const Restart restarts(execution_.gl, restart, restart_index);
    execution_.gl.DrawElementsInstancedBaseVertex(
        mode, count, type, reinterpret_cast<const void*>(static_cast<std::uintptr_t>(offset)), instances, base_vertex);
}

void InstancedDrawCommands::DrawIndicesInstanced(ClientName name, GLenum mode, GLenum type, std::int32_t base_vertex,
                                                 std::int32_t instances, std::uint32_t restart,
                                                 std::uint32_t restart_index, std::span<const std::byte> indices) {
    const auto count = draws_.count_indices(type, indices);
    const VertexInput* input = count ? begin(name, mode, *count, instances) : nullptr;
    if (input == nullptr) return;
    if (input->indices()) return execution_.refuse("the input's indices lie in a buffer");
    const Restart restarts(execution_.gl, restart, restart_index);
    execution_.gl.DrawElementsInstancedBaseVertex(mode, *count, type, indices.data(), instances, base_vertex);
}

}  // namespace wall::tileserver
