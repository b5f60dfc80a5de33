// SPDX-License-Identifier: MIT
#include "client_lib/context/buffer_binding.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/share_group.h"
#include "common/glstate/diff.h"

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

Buffer* buffer_of(Context& c, ClientName id) {
    const auto found = c.buffers->by_id.find(id);
    return found == c.buffers->by_id.end() ? nullptr : found->second.get();
}

namespace {

bool names_buffer(const glstate::State& state, ClientName id) {
    const auto& local = state.local;
    bool named = false;
    for (const std::uint32_t bound :
         {local.array_buffer, local.element_array_buffer, local.pixel_pack_buffer, local.pixel_unpack_buffer})
        named = named || bound == id.value;
    glstate::for_each_element([&]<class E>() {
        if constexpr (std::is_same_v<typename E::type, glstate::ClientArray>)
            for (unsigned i = 0; i < E::count; ++i) named = named || E::ref(state, i).buffer == id.value;
    });
    return named;
}

bool names_buffer(const Context& c, ClientName id) {
    const auto& saved = c.attributes->client;
    return names_buffer(c.state, id) ||
           std::any_of(saved.begin(), saved.end(), [&](const auto& s) { return names_buffer(s->state, id); });
}

}  // namespace

bool buffers_were_deleted(const Context& c) {
    return c.buffers->deletions != c.share().buffer_deletions.load(std::memory_order_acquire);
}

void let_go_of_deleted_buffers(Context& c) {
    BufferUse& use = *c.buffers;
    use.deletions = c.share().buffer_deletions.load(std::memory_order_acquire);
    use.holds_deleted = false;
    std::lock_guard lock(c.share().mutex);
    std::erase_if(use.by_id, [&](const auto& entry) {
        if (!entry.second->deleted) return false;
        const bool named = names_buffer(c, entry.first);
        use.holds_deleted = use.holds_deleted || named;
        return !named;
    });
}

BufferReading buffer_content(Context& c, ClientName id, std::uintptr_t offset) {
    if (buffers_were_deleted(c)) let_go_of_deleted_buffers(c);
    const Buffer* buffer = buffer_of(c, id);
    if (!buffer) return {};
    std::lock_guard lock(c.share().mutex);
    return offset < buffer->size() ? buffer->read(offset) : BufferReading();
}

namespace {

/// Null with an error if the bytes are not within the buffer, or the application has it mapped.
std::byte* bytes_within(Context& c, ClientName id, const void* pointer, std::size_t bytes, bool to_write) {
    Buffer* buffer = buffer_of(c, id);
    const auto offset = reinterpret_cast<std::uintptr_t>(pointer);
    c.buffers->transfer = {};
    std::lock_guard lock(c.share().mutex);
    if (!buffer || buffer->mapped || offset > buffer->size() || bytes > buffer->size() - offset) {
        c.error(GL_INVALID_OPERATION);
        return nullptr;
    }
    if (to_write) buffer->leave_to_readers();
    c.buffers->transfer = buffer->read(offset);
    return c.buffers->transfer.bytes().data();
}

}  // namespace

const void* unpack_source(Context& c, const void* pointer, std::size_t bytes) {
    const ClientName id(c.state.local.pixel_unpack_buffer);
    return !id ? pointer : bytes_within(c, id, pointer, bytes, false);
}

void* pack_target(Context& c, void* pointer, std::size_t bytes) {
    const ClientName id(c.state.local.pixel_pack_buffer);
    return !id ? pointer : bytes_within(c, id, pointer, bytes, true);
}

}  // namespace wall::client
