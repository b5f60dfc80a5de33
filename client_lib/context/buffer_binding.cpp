// SPDX-License-Identifier: MIT
#include "client_lib/context/buffer_binding.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "client_lib/context/array_copies.h"
#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/captured_content.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/indexed_buffers.h"
#include "client_lib/context/staging_buffers.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/objects/share_group.h"
#include "common/glstate/diff.h"

namespace wall::client {

namespace {

constexpr GLenum kTargets[] = {GL_ARRAY_BUFFER,
                               GL_ELEMENT_ARRAY_BUFFER,
                               GL_PIXEL_PACK_BUFFER,
                               GL_PIXEL_UNPACK_BUFFER,
                               GL_COPY_READ_BUFFER,
                               GL_COPY_WRITE_BUFFER,
                               GL_UNIFORM_BUFFER,
                               GL_TRANSFORM_FEEDBACK_BUFFER,
                               GL_TEXTURE_BUFFER,
                               GL_DRAW_INDIRECT_BUFFER,
                               GL_SHADER_STORAGE_BUFFER,
                               GL_ATOMIC_COUNTER_BUFFER,
                               GL_DISPATCH_INDIRECT_BUFFER,
                               GL_QUERY_BUFFER};

/// Calls use.operator()<E>() with the binding's element; false: no such target.
template <class Use>
bool with_binding(GLenum target, Use&& use) {
    namespace el = glstate::el;
    switch (target) {
        case GL_ARRAY_BUFFER: return use.template operator()<el::array_buffer>(), true;
        case GL_ELEMENT_ARRAY_BUFFER: return use.template operator()<el::element_array_buffer>(), true;
        case GL_COPY_READ_BUFFER: return use.template operator()<el::copy_read_buffer>(), true;
        case GL_COPY_WRITE_BUFFER: return use.template operator()<el::copy_write_buffer>(), true;
        case GL_PIXEL_PACK_BUFFER: return use.template operator()<el::pixel_pack_buffer>(), true;
        case GL_UNIFORM_BUFFER: return use.template operator()<el::bound_uniform_buffer>(), true;
        case GL_TEXTURE_BUFFER: return use.template operator()<el::bound_texture_buffer>(), true;
        case GL_TRANSFORM_FEEDBACK_BUFFER: return use.template operator()<el::bound_feedback_buffer>(), true;
        case GL_QUERY_BUFFER: return use.template operator()<el::query_buffer>(), true;
        case GL_DRAW_INDIRECT_BUFFER: return use.template operator()<el::draw_indirect_buffer>(), true;
        case GL_SHADER_STORAGE_BUFFER: return use.template operator()<el::bound_storage_buffer>(), true;
        case GL_ATOMIC_COUNTER_BUFFER: return use.template operator()<el::bound_counter_buffer>(), true;
        case GL_DISPATCH_INDIRECT_BUFFER: return use.template operator()<el::dispatch_indirect_buffer>(), true;
        case GL_PIXEL_UNPACK_BUFFER: return use.template operator()<el::pixel_unpack_buffer>(), true;
        default: return false;
    }
}

}  // namespace

std::optional<ClientName> bound_buffer_id(const Context& c, GLenum target) {
    ClientName id;
    const bool known = with_binding(target, [&]<class E>() { id = ClientName(E::ref(c.state)); });
    return known ? std::optional(id) : std::nullopt;
}

void bind_buffer(Context& c, GLenum target, ClientName id) {
    with_binding(target, [&]<class E>() { c.set<E>(0, id.value); });
}

Buffer* buffer_of(Context& c, ClientName id) {
    const auto found = c.buffers->by_id.find(id);
    return found == c.buffers->by_id.end() ? nullptr : found->second.get();
}

namespace {

/// Calls use.operator()<E>(i) with each array of the state.
template <class Use>
void for_each_array(Use&& use) {
    glstate::for_each_element([&]<class E>() {
        if constexpr (std::is_same_v<typename E::type, glstate::ClientArray>)
            for (unsigned i = 0; i < E::count; ++i) use.template operator()<E>(i);
    });
}

void add_named_by_arrays(const glstate::State& state, std::vector<std::uint32_t>& ids) {
    const auto add = [&](std::uint32_t id) {
        if (id != 0) ids.push_back(id);
    };
    add(state.vertex_arrays.element_array_buffer);
    for_each_array([&]<class E>(unsigned i) { add(E::ref(state, i).buffer); });
}

void add_named_by_bindings(const VertexBindings* bindings, std::vector<std::uint32_t>& ids) {
    for (unsigned i = 0; bindings && i < kVertexBindings; ++i) ids.push_back(bindings->bindings[i].buffer);
}

void add_named(const glstate::State& state, std::vector<std::uint32_t>& ids) {
    const auto& local = state.local;
    ids.insert(ids.end(),
               {local.array_buffer, local.pixel_pack_buffer, local.pixel_unpack_buffer, local.copy_read_buffer,
                local.copy_write_buffer, local.bound_uniform_buffer, local.bound_feedback_buffer,
                local.bound_texture_buffer, local.draw_indirect_buffer, local.bound_storage_buffer,
                local.bound_counter_buffer, local.dispatch_indirect_buffer, local.query_buffer});
    for (const glstate::BufferRange& range : state.shader_memory.storage_buffer) ids.push_back(range.buffer);
    for (const glstate::BufferRange& range : state.shader_memory.counter_buffer) ids.push_back(range.buffer);
    for (const glstate::BufferRange& range : local.feedback_buffer) ids.push_back(range.buffer);
    for (const glstate::BufferRange& range : state.uniform_buffers.uniform_buffer) ids.push_back(range.buffer);
    add_named_by_arrays(state, ids);
}

/// Ids of the buffers that the context names in any way, sorted.
std::vector<std::uint32_t> named_buffers(const Context& c) {
    std::vector<std::uint32_t> ids;
    add_named(c.state, ids);
    c.captures->for_each_object([&](const FeedbackObject& object) {
        for (const glstate::BufferRange& range : object.buffers) ids.push_back(range.buffer);
        if (!object.active) return;
        for (const CapturedPart& part : object.active->parts())
            if (part.buffer) ids.push_back(part.buffer->id.value);
    });
    for (const auto& saved : c.attributes->client) {
        add_named(saved->state, ids);
        add_named_by_bindings(saved->bindings.get(), ids);
    }
    glstate::State looked_at;
    add_named_by_bindings(c.vertex_array_objects->bindings.get(), ids);
    c.vertex_array_objects->for_each_kept(
        [&](const glstate::VertexArraysState& arrays, const VertexBindings* bindings) {
            looked_at.vertex_arrays = arrays;
            add_named_by_arrays(looked_at, ids);
            add_named_by_bindings(bindings, ids);
        });
    std::ranges::sort(ids);
    return ids;
}

bool names_buffer(const Context& c, ClientName id) { return std::ranges::binary_search(named_buffers(c), id.value); }

}  // namespace

bool buffers_were_deleted(const Context& c) {
    return c.buffers->deletions != c.share().buffer_deletions.load(std::memory_order_acquire);
}

bool deleted_buffers_are_due(Context& c) {
    if (buffers_were_deleted(c)) return true;
    BufferUse& use = *c.buffers;
    if (!use.holds_deleted) return false;
    // Looking for them costs as much as there are buffers and vertex array objects; a program that deletes the names of
    // buffers that vertex array objects keep must not pay that for every glBindBuffer.
    constexpr std::size_t kPerCall = 4;
    return ++use.calls_since_look > (use.by_id.size() + c.vertex_array_objects->size()) / kPerCall;
}

void let_go_of_deleted_buffers(Context& c) {
    BufferUse& use = *c.buffers;
    use.calls_since_look = 0;
    use.bound_lately.forget();
    use.deletions = c.share().buffer_deletions.load(std::memory_order_acquire);
    use.holds_deleted = false;
    std::vector<std::shared_ptr<Buffer>> unnamed;
    const auto named = named_buffers(c);
    {
        std::lock_guard lock(c.share().mutex);
        for (const auto& [id, buffer] : use.by_id) {
            if (!buffer->deleted) continue;
            if (std::ranges::binary_search(named, id.value)) use.holds_deleted = true;
            else unnamed.push_back(buffer);
        }
    }
    for (auto& buffer : unnamed) let_go_of_buffer(c, std::move(buffer));
}

void let_go_of_own_buffer(Context& c, std::shared_ptr<Buffer> buffer) {
    const ClientName id = buffer->id;
    for (const GLenum target : kTargets)
        if (bound_buffer_id(c, target) == id) bind_buffer(c, target, {});
    unbind_indexed(c, id);
    if (!names_buffer(c, id)) return let_go_of_buffer(c, std::move(buffer));
    // In the arrays that are set now there is nothing in its place: a buffer that nobody has.
    const ClientName nothing = next_object_id();
    for_each_array([&]<class E>(unsigned i) {
        glstate::ClientArray array = E::ref(c.state, i);
        if (array.buffer != id.value) return;
        array.buffer = nothing.value;
        c.set<E>(i, array);
    });
    if (const auto& bindings = c.vertex_array_objects->bindings)
        for (VertexBinding& binding : bindings->bindings)
            if (binding.buffer == id.value) binding.buffer = nothing.value;
    if (names_buffer(c, id)) c.buffers->holds_deleted = true;
    else let_go_of_buffer(c, std::move(buffer));
}

void let_go_of_buffer(Context& c, std::shared_ptr<Buffer> buffer) {
    const ClientName id = buffer->id;
    forget_inputs(c, c.inputs->take_those_of(id));
    c.buffers->by_id.erase(id);
    forget_unused(c, std::move(buffer));
}

void let_go_of_all_buffers(Context& c) {
    for (auto& [place, buffer] : std::exchange(c.staging->by_place, {})) buffer->deleted = true;
    for (auto& buffer : c.copies->take_all()) buffer->deleted = true;
    auto named = std::exchange(c.buffers->by_id, {});
    for (auto& [id, buffer] : named) let_go_of_buffer(c, std::move(buffer));
}

void before_writing(Context& c, const Buffer& buffer) {
    c.buffers->transfer = {};
    if (!c.packer.empty() && is_read_buffer(c, buffer.id)) c.flush_block();
    c.before_change(buffer.id);
}

BufferReading buffer_content(Context& c, ClientName id, std::uintptr_t offset) {
    if (buffers_were_deleted(c)) let_go_of_deleted_buffers(c);
    fetch_captured(c, id, "vertices");
    const Buffer* buffer = buffer_of(c, id);
    if (!buffer) return {};
    std::lock_guard lock(c.share().mutex);
    return offset < buffer->size() ? buffer->read(offset) : BufferReading();
}

namespace {

/// Whether a pixel command may use these bytes: they are in the buffer, and the application does not have it mapped.
/// Else there is an error.
bool may_use(Context& c, const Buffer* buffer, std::uintptr_t offset, std::size_t bytes) {
    if (buffer && !buffer->blocked() && offset <= buffer->size() && bytes <= buffer->size() - offset) return true;
    c.error(GL_INVALID_OPERATION);
    return false;
}

}  // namespace

const void* unpack_source(Context& c, const void* pointer, std::size_t bytes) {
    const ClientName id(c.state.local.pixel_unpack_buffer);
    if (!id) return pointer;
    fetch_captured(c, id, "pixels");
    const Buffer* buffer = buffer_of(c, id);
    const auto offset = reinterpret_cast<std::uintptr_t>(pointer);
    c.buffers->transfer = {};
    std::lock_guard lock(c.share().mutex);
    if (!may_use(c, buffer, offset, bytes)) return nullptr;
    c.buffers->transfer = buffer->read(offset);
    return c.buffers->transfer.bytes().data();
}

PackTarget pack_target(Context& c, void* pointer, std::size_t bytes) {
    const ClientName id(c.state.local.pixel_pack_buffer);
    if (!id) return PackTarget(pointer);
    const auto found = c.buffers->by_id.find(id);
    const auto buffer = found == c.buffers->by_id.end() ? nullptr : found->second;
    const auto offset = reinterpret_cast<std::uintptr_t>(pointer);
    if (buffer) before_writing(c, *buffer);
    std::lock_guard lock(c.share().mutex);
    if (!may_use(c, buffer.get(), offset, bytes)) return PackTarget(nullptr);
    return PackTarget(c.share(), buffer, {offset, offset + bytes});
}

PackTarget::PackTarget(ShareGroup& share, std::shared_ptr<Buffer> buffer, ByteRange range)
    : share_(&share), buffer_(std::move(buffer)), range_(range) {
    buffer_->begin_writing();
    reading_ = buffer_->read(range.begin);
    at_ = reading_.bytes().data();
}

PackTarget::~PackTarget() {
    if (!buffer_) return;
    std::lock_guard lock(share_->mutex);
    buffer_->wrote(range_);
}

}  // namespace wall::client
