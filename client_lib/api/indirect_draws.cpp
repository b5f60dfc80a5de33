// SPDX-License-Identifier: MIT
// Draws whose arguments lie in a buffer (OpenGL 4.3, 10.4). The client has the buffer's content, reads them and draws;
// what only nodes have of it, because transform feedback wrote it, is fetched first.
#include <algorithm>
#include <cstring>
#include <vector>

#include "client_lib/api/array_draws.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/captured_content.h"
#include "client_lib/context/profile.h"
#include "common/glstate/vertex_input.h"

namespace wall::client::api {
namespace {

struct ArraysCommand {
    GLuint count, instances, first, base_instance;
};
struct ElementsCommand {
    GLuint count, instances, first_index;
    GLint base_vertex;
    GLuint base_instance;
};

/// Where commands lie: `count` of them, `stride` bytes from one to the next; stride 0: they lie close.
struct Commands {
    std::uintptr_t place;
    GLsizei count, stride;
};

/// In OpenGL ES everything that is drawn comes from buffers, by a vertex array object (OpenGL ES 3.1, 10.5).
bool is_all_in_buffers(const Context& c) {
    if (!c.profile.is_es()) return true;
    const auto& arrays = c.state.vertex_arrays;
    return arrays.vertex_array_object != 0 && std::ranges::none_of(arrays.attrib_array, [](const auto& array) {
               return array.enabled && array.buffer == 0;
           });
}

/// What lies there in the buffer of commands, or, where there is none and it may be so, in memory. Nothing, and an
/// error: not all of it is in the buffer, which may also be mapped.
template <class Command>
std::vector<Command> read_commands(Context& c, Commands wanted) {
    const ClientName id(c.state.local.draw_indirect_buffer);
    const bool anywhere = !c.profile.core && !c.profile.is_es();
    const auto refuse = [&](GLenum error) { return c.error(error), std::vector<Command>(); };
    if (!c.at_once() || (!id && !anywhere) || !is_all_in_buffers(c)) return refuse(GL_INVALID_OPERATION);
    if (wanted.place % sizeof(GLuint) != 0 || wanted.count < 0 || wanted.stride < 0 || wanted.stride % 4 != 0)
        return refuse(GL_INVALID_VALUE);
    const std::size_t step = wanted.stride != 0 ? static_cast<std::size_t>(wanted.stride) : sizeof(Command);
    const auto count = static_cast<std::size_t>(wanted.count);
    if (count == 0) return {};
    fetch_captured(c, id, "glDraw*Indirect");
    std::lock_guard lock(c.share().mutex);
    const Buffer* buffer = id ? buffer_of(c, id) : nullptr;
    const auto* from = reinterpret_cast<const std::byte*>(wanted.place);
    if (id) {
        const std::uint64_t bytes = std::uint64_t{step} * (count - 1) + sizeof(Command);
        if (!buffer || buffer->blocked() || bytes > buffer->size() || wanted.place > buffer->size() - bytes)
            return refuse(GL_INVALID_OPERATION);
        from = buffer->data() + wanted.place;
    }
    std::vector<Command> commands(count);
    for (std::size_t i = 0; i < count; ++i) std::memcpy(&commands[i], from + i * step, sizeof(Command));
    return commands;
}

/// Whether they are arguments of a draw. (A larger one is not defined, and would not lie in any buffer.)
bool is_drawable(GLuint count, GLuint instances, GLuint first) {
    constexpr GLuint kMost = 0x7fffffff;
    return count != 0 && instances != 0 && count <= kMost && instances <= kMost && first <= kMost;
}

}  // namespace

void MultiDrawArraysIndirect(Context& c, GLenum mode, const void* indirect, GLsizei draws, GLsizei stride) {
    if (!check_mode(c, mode)) return;
    for (const auto& command :
         read_commands<ArraysCommand>(c, {reinterpret_cast<std::uintptr_t>(indirect), draws, stride}))
        if (is_drawable(command.count, command.instances, command.first))
            draw(c, {.mode = mode,
                     .first = static_cast<GLint>(command.first),
                     .count = static_cast<GLsizei>(command.count),
                     .instances = static_cast<GLsizei>(command.instances),
                     .base_instance = command.base_instance});
}

void MultiDrawElementsIndirect(Context& c, GLenum mode, GLenum type, const void* indirect, GLsizei draws,
                               GLsizei stride) {
    if (!check_indices(c, mode, 0, type)) return;
    if (c.state.vertex_arrays.element_array_buffer == 0) return c.error(GL_INVALID_OPERATION);
    for (const auto& command :
         read_commands<ElementsCommand>(c, {reinterpret_cast<std::uintptr_t>(indirect), draws, stride})) {
        if (!is_drawable(command.count, command.instances, 0)) continue;
        const auto offset = std::uintptr_t{command.first_index} * glstate::index_bytes(type);
        draw_indexed(c, {.mode = mode,
                         .count = static_cast<GLsizei>(command.count),
                         .index_type = type,
                         .indices = reinterpret_cast<const void*>(offset),
                         .base_vertex = command.base_vertex,
                         .instances = static_cast<GLsizei>(command.instances),
                         .base_instance = command.base_instance});
    }
}

}  // namespace wall::client::api
