// SPDX-License-Identifier: MIT
#include "tileserver/session/shader_memory.h"

#include <algorithm>

#include "common/glapi/image_units.h"
#include "gen/glapi/texture_targets.gen.h"
#include "tileserver/objects/buffer.h"
#include "tileserver/objects/texture.h"

namespace wall::tileserver {
namespace {

namespace el = glstate::el;

Texture* texture_of(const SessionReplica& session, const glstate::ImageUnit& image) {
    return image.texture != 0 ? session.objects.find<Texture>(ClientName(image.texture)) : nullptr;
}

/// In the driver's name; nothing, where there is no such texture or the driver would refuse it: what it had bound
/// before would stay.
glstate::ImageUnit found_image(const SessionReplica& session, const glstate::ImageUnit& wanted) {
    constexpr glstate::ImageUnit kNothing{0, 0, 0, 0, GL_READ_ONLY, GL_R8};
    const Texture* texture = texture_of(session, wanted);
    if (texture == nullptr || wanted.level < 0 || wanted.layer < 0) return kNothing;
    if (!glapi::is_image_access(wanted.access) || !glapi::is_image_unit_format(wanted.format)) return kNothing;
    glstate::ImageUnit found = wanted;
    found.texture = texture->content().name();
    found.layered = wanted.layered != 0;
    return found;
}

/// The part in the driver's name, as large as the buffer is now; nothing: it is not there, or the driver would refuse
/// it.
glstate::BufferRange found_part(const SessionReplica& session, const glstate::BufferRange& wanted,
                                std::uint32_t alignment) {
    Buffer* buffer = wanted.buffer != 0 ? session.objects.find<Buffer>(ClientName(wanted.buffer)) : nullptr;
    if (buffer == nullptr || wanted.offset >= buffer->size() || wanted.offset % alignment != 0) return {};
    buffer->may_be_written();
    const auto rest = static_cast<std::uint32_t>(buffer->size() - wanted.offset);
    return {buffer->name(), wanted.offset, wanted.size != 0 ? std::min(wanted.size, rest) : rest};
}

}  // namespace

bool own_written_textures(RenderNode& node, SessionReplica& session, const glstate::State& state) {
    bool images = false;
    for_each_program(session, state, [&](const Program& program) { images = images || program.has_images(); });
    if (!images) return true;
    return std::ranges::all_of(state.shader_memory.image_unit, [&](const glstate::ImageUnit& image) {
        Texture* texture = image.access != GL_READ_ONLY ? texture_of(session, image) : nullptr;
        return texture == nullptr || texture->own(node.shared);
    });
}

void bind_memory(RenderNode& node, const SessionReplica& session, const glstate::State& state, const Program& program) {
    if (!program.touches_memory()) return;
    Driver& driver = node.driver;
    driver.touches_memory();
    if (program.has_images())
        for (unsigned unit = 0; unit < el::image_unit::count; ++unit)
            driver.bind_image(unit, found_image(session, el::image_unit::ref(state, unit)));
    for (const std::uint32_t place : program.storage_bindings())
        driver.bind_storage_buffer(
            place, found_part(session, el::storage_buffer::ref(state, place), driver.storage_buffer_alignment()));
    for (const std::uint32_t place : program.counter_bindings())
        driver.bind_counter_buffer(place, found_part(session, el::counter_buffer::ref(state, place), 4));
}

}  // namespace wall::tileserver
