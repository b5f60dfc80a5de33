// SPDX-License-Identifier: MIT
#include "client_lib/context/shader_memory.h"

#include <mutex>
#include <utility>

#include "client_lib/context/buffer_use.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/texture.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

/// Calls use(image, texture) with the images that the program names, of which there are textures.
template <class Use>
void for_each_image(const Context& c, Use&& use) {
    c.program->executable->for_each_image_unit([&](std::uint32_t unit) {
        if (unit >= el::image_unit::count) return;
        const glstate::ImageUnit& image = c.get<el::image_unit>(unit);
        const auto found = image.texture != 0 ? c.share().by_id.find(ClientName(image.texture)) : c.share().by_id.end();
        if (found != c.share().by_id.end()) use(image, static_cast<Texture&>(*found->second));
    });
}

std::shared_ptr<Buffer> buffer_of(const Context& c, const glstate::BufferRange& range) {
    const auto found = c.buffers->by_id.find(ClientName(range.buffer));
    return found != c.buffers->by_id.end() ? found->second : nullptr;
}

/// Calls use(buffer, written) with those of blocks of storage and counters.
template <class Use>
void for_each_block_buffer(const Context& c, Use&& use) {
    c.program->executable->for_each_part([&](const Executable& part) {
        for (const StorageBlock& block : part.storage_blocks)
            if (block.binding < el::storage_buffer::count)
                if (const auto buffer = buffer_of(c, c.get<el::storage_buffer>(block.binding)))
                    use(buffer, block.written);
        for (const glapi::ActiveCounterBuffer& counters : part.counter_buffers)
            if (counters.binding < el::counter_buffer::count)
                if (const auto buffer = buffer_of(c, c.get<el::counter_buffer>(counters.binding))) use(buffer, true);
    });
}

bool touches_memory(const Context& c) { return c.program && c.program->executable->touches_memory(); }

}  // namespace

void for_each_touched_buffer(const Context& c, const std::function<void(const std::shared_ptr<Buffer>&)>& use) {
    if (!touches_memory(c)) return;
    for_each_block_buffer(c, [&](const auto& buffer, bool) { use(buffer); });
    for_each_image(c, [&](const glstate::ImageUnit&, const Texture& texture) {
        if (texture.part.buffer) use(texture.part.buffer);
    });
}

void for_each_touched(const Context& c, const std::function<void(const Object&)>& use) {
    if (!touches_memory(c)) return;
    for_each_touched_buffer(c, [&](const auto& buffer) { use(*buffer); });
    for_each_image(c, [&](const glstate::ImageUnit&, Texture& texture) { use(texture); });
}

void for_each_written(const Context& c, const std::function<void(const Object&)>& use) {
    if (c.memory->work) return use(*c.memory->work->written);
    if (!touches_memory(c)) return;
    for_each_block_buffer(c, [&](const auto& buffer, bool written) {
        if (written) use(*buffer);
    });
    for_each_image(c, [&](const glstate::ImageUnit& image, Texture& texture) {
        if (image.access == GL_READ_ONLY) return;
        use_with_base(texture, use);
        if (texture.part.buffer) use(*texture.part.buffer);
    });
}

bool writes_memory(const Context& c) {
    if (c.memory->work) return true;
    if (!c.program || !c.memory->any) return false;
    std::lock_guard lock(c.share().mutex);
    bool writes = false;
    for_each_written(c, [&](const Object&) { writes = true; });
    return writes;
}

void note_written(const Context& c) {
    if (c.memory->work) return c.memory->work->note_drawn();
    for_each_block_buffer(c, [&](const auto& buffer, bool written) {
        if (written) buffer->note_drawn();
    });
    for_each_image(c, [&](const glstate::ImageUnit& image, Texture& texture) {
        if (image.access != GL_READ_ONLY) texture.note_written(image.level, image.layered != 0, image.layer);
    });
}

void unbind_images(Context& c, ClientName texture) {
    for (unsigned unit = 0; unit < el::image_unit::count; ++unit)
        if (c.get<el::image_unit>(unit).texture == texture.value)
            c.set<el::image_unit>(unit, {0, 0, 0, 0, GL_READ_ONLY, GL_R8});
}

}  // namespace wall::client
