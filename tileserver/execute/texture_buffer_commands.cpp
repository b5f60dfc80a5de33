// SPDX-License-Identifier: MIT
#include "tileserver/execute/texture_buffer_commands.h"

#include "tileserver/objects/buffer.h"
#include "tileserver/objects/texture.h"

namespace wall::tileserver {

// What the driver does not take of it has no texels: those of before may be a part that is gone.
void TextureBufferCommands::TexBuffer(ClientName name, GLenum internal_format, ClientName buffer_name,
                                      std::uint32_t offset, std::uint32_t bytes) {
    constexpr TextureTarget kTarget = TextureTarget::buffer;
    const auto texture =
        execution_.session.objects.make<Texture>(Texture::key(name, kTarget), execution_.node.driver, kTarget);
    if (!texture) return execution_.refuse(texture.error().message);
    if ((*texture)->target() != kTarget) return execution_.refuse("the texture has another target");
    Buffer* buffer = nullptr;
    if (buffer_name) {
        const auto found = execution_.session.objects.look_up<Buffer>(buffer_name);
        if (!found) return execution_.refuse(found.error().message);
        buffer = *found;
    }
    const GLuint driver_name = (*texture)->content().name();
    const Gl& gl = execution_.gl;
    gl.TextureBuffer(driver_name, internal_format, 0);
    if (buffer == nullptr) return;
    buffer->give_texels();
    if (bytes == 0 && offset == 0) gl.TextureBuffer(driver_name, internal_format, buffer->name());
    else if (offset < buffer->size() && bytes <= buffer->size() - offset)
        gl.TextureBufferRange(driver_name, internal_format, buffer->name(), offset, static_cast<GLsizeiptr>(bytes));
}

}  // namespace wall::tileserver
