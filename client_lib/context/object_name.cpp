// SPDX-License-Identifier: MIT
#include "client_lib/context/object_name.h"

#include "client_lib/context/buffer_binding.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

GLuint object_name(Context& c, glstate::ValueKind kind, ClientName id) {
    ShareGroup& share = c.share();
    std::lock_guard lock(share.mutex);
    const auto name_in = [id](const auto& objects) {
        const auto found = objects.find(id);
        return found == objects.end() ? GLuint{0} : found->second->name;
    };
    switch (kind) {
        case glstate::ValueKind::name_texture:
        case glstate::ValueKind::name_sampler:
        case glstate::ValueKind::name_program: return name_in(share.by_id);
        case glstate::ValueKind::name_buffer: return name_in(c.buffers->by_id);
        case glstate::ValueKind::name_vertex_array: return id.value;  // no other context has it
        default: return 0;                                            // nothing of this kind can be bound yet
    }
}

}  // namespace wall::client
