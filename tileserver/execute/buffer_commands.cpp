// SPDX-License-Identifier: MIT
#include "tileserver/execute/buffer_commands.h"

#include "tileserver/objects/buffer.h"

namespace wall::tileserver {

void BufferCommands::BufferData(ClientName name, std::uint32_t size, GLenum usage) {
    const auto buffer = execution_.session.objects.make<Buffer>(name, execution_.node.driver);
    if (!buffer) return execution_.refuse(buffer.error().message);
    if (!(*buffer)->affords_size(size)) return execution_.refuse("more memory of objects than a session may have");
    if (!(*buffer)->define(size, usage)) execution_.refuse("the driver has no memory for a buffer of that size");
}

void BufferCommands::BufferSubData(ClientName name, std::uint32_t offset, std::span<const std::byte> content) {
    const auto buffer = execution_.session.objects.get<Buffer>(name);
    if (!buffer) return execution_.refuse(buffer.error().message);
    if (!(*buffer)->write(offset, content)) execution_.refuse("content reaches over the end of its buffer");
}

}  // namespace wall::tileserver
