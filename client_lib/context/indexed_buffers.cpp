// SPDX-License-Identifier: MIT
#include "client_lib/context/indexed_buffers.h"

#include <algorithm>
#include <vector>

#include "client_lib/context/buffer_use.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

}  // namespace

void for_each_uniform_buffer(const Context& c, const std::function<void(ClientName)>& use) {
    if (!c.program) return;
    for (const UniformBlock& block : c.program->executable->blocks) {
        if (block.binding >= el::uniform_buffer::count) continue;
        if (const ClientName id(c.get<el::uniform_buffer>(block.binding).buffer); id) use(id);
    }
}

std::uint64_t latest_of_uniform_buffers(const Context& c) {
    if (!c.program) return 0;
    std::lock_guard lock(c.share().mutex);
    std::uint64_t latest = 0;
    for_each_uniform_buffer(c, [&](ClientName id) {
        const auto found = c.share().by_id.find(id);
        if (found != c.share().by_id.end()) latest = std::max(latest, found->second->latest());
    });
    return latest;
}

bool is_uniform_buffer(const Context& c, ClientName id) {
    if (!c.program) return false;
    std::lock_guard lock(c.share().mutex);
    bool is = false;
    for_each_uniform_buffer(c, [&](ClientName used) { is = is || used == id; });
    return is;
}

void find_written_uniforms(Context& c) {
    if (!c.program) return;
    std::vector<std::shared_ptr<Buffer>> mapped;
    {
        std::lock_guard lock(c.share().mutex);
        for_each_uniform_buffer(c, [&](ClientName id) {
            const auto found = c.buffers->by_id.find(id);
            if (found != c.buffers->by_id.end() && found->second->written_unseen()) mapped.push_back(found->second);
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
    for (unsigned i = 0; i < el::uniform_buffer::count; ++i)
        if (c.get<el::uniform_buffer>(i).buffer == id.value) c.set<el::uniform_buffer>(i, {});
}

}  // namespace wall::client
