// SPDX-License-Identifier: MIT
#include "client_lib/context/forget_objects.h"

#include <mutex>
#include <utility>

#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/shader_memory.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

/// Its origin has one view less, and may have been waiting for that.
void forget_view(Context& c, const Texture& view) {
    const auto& origin = view.view.origin;
    if (!origin || --origin->views != 0) return;
    if (origin->orphan) forget_texture(c, origin);
}

}  // namespace

void forget(Context& c, ClientName id) {
    c.forget_object(id);
    std::lock_guard lock(c.share().mutex);
    c.share().by_id.erase(id);
}

void forget_ranges(Context& c, VertexInput& input) {
    for (const auto& pieces : input.take_pieces()) forget(c, pieces->id);
}

void forget_inputs(Context& c, const std::vector<std::shared_ptr<VertexInput>>& inputs) {
    for (const auto& input : inputs) {
        forget_ranges(c, *input);
        forget(c, input->id);
    }
}

void forget_unused(Context& c, std::shared_ptr<Buffer> buffer) {
    {
        std::lock_guard lock(c.share().mutex);
        const bool others = buffer.use_count() > 2;  // the table by id, and this
        if (!buffer->deleted || others) return;
        c.share().by_id.erase(buffer->id);
    }
    c.forget_object(buffer->id);
}

void forget_texture(Context& c, const std::shared_ptr<Texture>& texture) {
    const glapi::TextureTarget target = texture->info.id;
    for (unsigned unit = 0; unit < kTextureImageUnits; ++unit) {
        if (bound_id(c, unit, target) != texture->id) continue;
        ClientName id;
        {
            std::lock_guard lock(c.share().mutex);
            id = default_id(c.share(), target);
        }
        set_bound_id(c, unit, target, id);
    }
    unbind_images(c, texture->id);
    texture->orphan = true;
    detach_from_bound(c, *texture);
    if (is_attached(c, *texture) || texture->views != 0) return;
    // Another context of the group may still have it bound; then it lives on without a name.
    if (texture->bound_by.size() > 1 || (!texture->bound_by.empty() && texture->bound_by[0] != c.id)) return;
    forget(c, texture->id);
    forget_view(c, *texture);
    if (auto buffer = std::exchange(texture->part.buffer, nullptr)) forget_unused(c, std::move(buffer));
}

void forget_orphan(Context& c, const Renderbuffer& renderbuffer) {
    if (!renderbuffer.orphan || is_attached(c, renderbuffer)) return;
    const ClientName id = renderbuffer.id;
    c.forget_object(id);
    std::lock_guard lock(c.share().mutex);
    c.share().by_id.erase(id);
}

void forget_orphan(Context& c, const Attachment& attachment) {
    if (attachment.renderbuffer) forget_orphan(c, *attachment.renderbuffer);
    if (attachment.texture && attachment.texture->orphan) forget_texture(c, attachment.texture);
}

}  // namespace wall::client
