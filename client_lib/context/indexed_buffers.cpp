// SPDX-License-Identifier: MIT
#include "client_lib/context/indexed_buffers.h"

#include <algorithm>
#include <vector>

#include "client_lib/context/buffer_use.h"
#include "client_lib/context/shader_memory.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

template <class E>
void unbind(Context& c, ClientName id) {
    for (unsigned i = 0; i < E::count; ++i)
        if (c.get<E>(i).buffer == id.value) c.set<E>(i, {});
}

}  // namespace

void for_each_read_buffer(const Context& c, const std::function<void(const std::shared_ptr<Buffer>&)>& use) {
    if (!c.program || !c.program->executable->reads_buffers()) return;
    const Executable& executable = *c.program->executable;
    executable.for_each_part([&](const Executable& part) {
        for (const UniformBlock& block : part.blocks) {
            if (block.binding >= el::uniform_buffer::count) continue;
            const auto found = c.buffers->by_id.find(ClientName(c.get<el::uniform_buffer>(block.binding).buffer));
            if (found != c.buffers->by_id.end()) use(found->second);
        }
    });
    for_each_touched_buffer(c, use);
    executable.for_each_sampler([&](std::uint32_t unit, glapi::TextureTarget target) {
        if (target != glapi::TextureTarget::buffer || unit >= kTextureImageUnits) return;
        const auto found = c.share().by_id.find(bound_id(c, unit, target));
        if (found == c.share().by_id.end()) return;
        if (const auto& buffer = static_cast<const Texture&>(*found->second).part.buffer) use(buffer);
    });
}

std::uint64_t latest_of_read_buffers(const Context& c) {
    if (!c.program) return 0;
    std::lock_guard lock(c.share().mutex);
    std::uint64_t latest = 0;
    for_each_read_buffer(c, [&](const auto& buffer) { latest = std::max(latest, buffer->latest()); });
    return latest;
}

bool is_read_buffer(const Context& c, ClientName id) {
    if (!c.program) return false;
    std::lock_guard lock(c.share().mutex);
    bool is = false;
    for_each_read_buffer(c, [&](const auto& buffer) { is = is || buffer->id == id; });
    return is;
}

void find_written_to_read(Context& c) {
    if (!c.program) return;
    std::vector<std::shared_ptr<Buffer>> mapped;
    {
        std::lock_guard lock(c.share().mutex);
        for_each_read_buffer(c, [&](const auto& buffer) {
            if (buffer->written_unseen()) mapped.push_back(buffer);
        });
    }
    if (mapped.empty()) return;
    c.flush_block();
    for (const auto& buffer : mapped) {
        bool changed = false;
        {
            std::lock_guard lock(c.share().mutex);
            changed = buffer->written_unseen() && buffer->find_written(buffer->mapping()->range);
        }
        if (changed) c.before_change(buffer->id);
    }
}

void unbind_indexed(Context& c, ClientName id) {
    unbind<el::uniform_buffer>(c, id);
    unbind<el::feedback_buffer>(c, id);
    unbind<el::storage_buffer>(c, id);
    unbind<el::counter_buffer>(c, id);
}

}  // namespace wall::client
