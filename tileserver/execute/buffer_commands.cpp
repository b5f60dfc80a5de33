// SPDX-License-Identifier: MIT
#include "tileserver/execute/buffer_commands.h"

#include <vector>

#include "tileserver/objects/buffer.h"

namespace wall::tileserver {
namespace {

constexpr std::uint32_t kLargestRead = 16 << 20;

}  // namespace

void BufferCommands::BufferData(ClientName name, std::uint32_t size, GLenum usage) {
    const auto buffer = execution_.session.objects.make<Buffer>(name, execution_.node.driver);
    if (!buffer) return execution_.refuse(buffer.error().message);
    if (!(*buffer)->affords_size(size)) return execution_.refuse(too_much("memory of objects"));
    if (!(*buffer)->define(size, usage)) execution_.refuse("the driver has no memory for a buffer of that size");
}

void BufferCommands::BufferSubData(ClientName name, std::uint32_t offset, std::span<const std::byte> content) {
    const auto buffer = execution_.session.objects.get<Buffer>(name);
    if (!buffer) return execution_.refuse(buffer.error().message);
    if (!(*buffer)->write(offset, content)) execution_.refuse("content reaches over the end of its buffer");
}

void BufferCommands::BufferRead(RequestId request, ClientName name, std::uint32_t offset, std::uint32_t size) {
    const Timed timed(execution_.session.work.render);
    if (size > kLargestRead) return execution_.refuse("more of a buffer than an answer may have");
    const auto buffer = execution_.session.objects.look_up<Buffer>(name);
    if (!buffer) return execution_.refuse(buffer.error().message);
    execution_.output.reply(request, *buffer != nullptr ? (*buffer)->read(offset, size) : std::vector<std::byte>());
}

}  // namespace wall::tileserver
