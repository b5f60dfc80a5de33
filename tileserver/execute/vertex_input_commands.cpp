// SPDX-License-Identifier: MIT
#include "tileserver/execute/vertex_input_commands.h"

#include <vector>

#include "tileserver/objects/buffer.h"
#include "tileserver/objects/vertex_input.h"

namespace wall::tileserver {

void VertexInputCommands::VertexInput(ClientName name, std::span<const std::byte> bytes) {
    const auto definition = glstate::decode_vertex_input(bytes);
    if (!definition) return execution_.refuse("no definition of a vertex input");
    auto& objects = execution_.session.objects;
    std::vector<GLuint> buffers;
    const auto add = [&](ClientName id) {
        const auto buffer = objects.get<Buffer>(id);
        if (buffer) buffers.push_back((*buffer)->name());
        else execution_.refuse(buffer.error().message);
    };
    for (const glstate::InputArray& array : definition->arrays) add(array.buffer);
    if (definition->indices) add(definition->indices);
    if (execution_.refused()) return;
    const auto input = objects.make<tileserver::VertexInput>(name, execution_.node.driver);
    if (!input) return execution_.refuse(input.error().message);
    if ((*input)->defined()) return execution_.refuse("a vertex input is defined once");
    if (!(*input)->define(*definition, buffers)) execution_.refuse("no array of OpenGL");
}

}  // namespace wall::tileserver
