// SPDX-License-Identifier: MIT
#include "client_lib/buffer_binding.h"

#include "client_lib/share_group.h"

namespace wall::client {

std::uint32_t* buffer_binding(Context& c, GLenum target) {
    auto& local = c.state.local;
    switch (target) {
        case GL_ARRAY_BUFFER: return &local.array_buffer;
        case GL_ELEMENT_ARRAY_BUFFER: return &local.element_array_buffer;
        case GL_PIXEL_PACK_BUFFER: return &local.pixel_pack_buffer;
        case GL_PIXEL_UNPACK_BUFFER: return &local.pixel_unpack_buffer;
        default: return nullptr;
    }
}

std::shared_ptr<Buffer> buffer_of(Context& c, std::uint32_t id) {
    if (id == 0) return nullptr;
    std::lock_guard lock(c.share().mutex);
    const auto found = c.share().buffers_by_id.find(id);
    return found == c.share().buffers_by_id.end() ? nullptr : found->second;
}

std::span<const std::byte> buffer_content(Context& c, std::uint32_t id, std::uintptr_t offset) {
    const auto buffer = buffer_of(c, id);
    if (!buffer || offset >= buffer->content.size()) return {};
    return std::span<const std::byte>(buffer->content).subspan(offset);
}

namespace {

/// Null with an error if the bytes are not within the buffer, or the application has it mapped.
std::byte* bytes_within(Context& c, std::uint32_t id, const void* pointer, std::size_t bytes) {
    const auto buffer = buffer_of(c, id);
    const auto offset = reinterpret_cast<std::uintptr_t>(pointer);
    if (buffer && !buffer->mapped && offset <= buffer->content.size() && bytes <= buffer->content.size() - offset)
        return buffer->content.data() + offset;
    c.error(GL_INVALID_OPERATION);
    return nullptr;
}

}  // namespace

const void* unpack_source(Context& c, const void* pointer, std::size_t bytes) {
    const std::uint32_t id = c.state.local.pixel_unpack_buffer;
    return id == 0 ? pointer : bytes_within(c, id, pointer, bytes);
}

void* pack_target(Context& c, void* pointer, std::size_t bytes) {
    const std::uint32_t id = c.state.local.pixel_pack_buffer;
    return id == 0 ? pointer : bytes_within(c, id, pointer, bytes);
}

}  // namespace wall::client
