// SPDX-License-Identifier: MIT
#include "tileserver/execute/texture_drawn_commands.h"

#include <cstring>
#include <utility>
#include <vector>

#include "common/glapi/image.h"
#include "common/wire/limits.h"
#include "tileserver/objects/texture.h"

namespace wall::tileserver {
namespace {

constexpr std::int32_t kMaxTextureLevel = 16;

/// Of that target; null: the session has none.
Texture* find_texture(const SessionReplica& session, ClientName name, TextureTarget target) {
    Texture* texture = session.objects.find<Texture>(Texture::key(name, target));
    return texture != nullptr && texture->target() == target ? texture : nullptr;
}

}  // namespace

void TextureDrawnCommands::TexMipmaps(ClientName name, GLenum target, std::int32_t base, std::int32_t last) {
    if (base < 0 || last < 0) return execution_.refuse("no such levels");
    const auto kind = texture_target(target);
    if (!kind || !glapi::info_of(*kind).mipmaps) return execution_.refuse("no such target");
    Texture* texture = find_texture(execution_.session, name, *kind);
    if (texture == nullptr) return execution_.refuse("no such texture");
    if (!texture->own(execution_.node.shared)) return execution_.refuse(too_much("texture memory"));
    if (auto* hash = texture->hash()) hash->TexMipmaps(target, base, last);
    texture->content().make_mipmaps(base, last);
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
}

/// As the driver gives it: all of it, because of a cube map that lacks a face it gives no part.
void TextureDrawnCommands::read_face(const Image& image, const Part& part, std::span<std::byte> to) {
    const std::size_t row = to.size() / static_cast<std::size_t>(part.rows);
    std::vector<std::byte> face(row * static_cast<std::size_t>(image.extent.height));
    execution_.gl.GetTexImage(image.target, image.level, part.format, part.type, face.data());
    std::memcpy(to.data(), face.data() + row * static_cast<std::size_t>(part.first_row), to.size());
}

std::vector<std::byte> TextureDrawnCommands::read(const Image& image, const Part& part) {
    const auto& [width, height, depth] = image.extent;
    if (part.slice >= depth || part.rows > height || part.first_row > height - part.rows || width == 0) return {};
    const auto bytes = glapi::image_bytes(part.format, part.type, width, part.rows, 1);
    if (!bytes || *bytes > wire::kMaxFramePayload - 8) {
        execution_.refuse("no such format or type, or too large");
        return {};
    }
    std::vector<std::byte> out(*bytes);
    execution_.node.driver.neutral_pixel_transfer();
    if (image.is_face) read_face(image, part, out);
    else
        execution_.gl.GetTextureSubImage(image.name, image.level, 0, part.first_row, part.slice, width, part.rows, 1,
                                         part.format, part.type, static_cast<GLsizei>(out.size()), out.data());
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
    return out;
}

void TextureDrawnCommands::TexRead(RequestId request, ClientName name, GLenum target, std::int32_t level,
                                   std::int32_t slice, std::int32_t first_row, std::int32_t rows, GLenum format,
                                   GLenum type) {
    const auto kind = texture_target(target);
    const auto word = glapi::find_target_word(target);
    if (!kind || !word || !word->has_images() || word->info->images == 0) return execution_.refuse("no such target");
    if (level < 0 || level > kMaxTextureLevel || slice < 0 || first_row < 0 || rows < 1)
        return execution_.refuse("no such part of an image");
    std::vector<std::byte> answer;
    if (const Texture* texture = find_texture(execution_.session, name, *kind)) {
        Image image{texture->content().name(), target, level, word->info->first_face != 0, {}};
        execution_.node.driver.bind_texture_to_edit(*kind, image.name);
        const Gl& gl = execution_.gl;
        gl.GetTexLevelParameteriv(target, level, GL_TEXTURE_WIDTH, &image.extent.width);
        gl.GetTexLevelParameteriv(target, level, GL_TEXTURE_HEIGHT, &image.extent.height);
        gl.GetTexLevelParameteriv(target, level, GL_TEXTURE_DEPTH, &image.extent.depth);
        answer = read(image, {slice, first_row, rows, format, type});
    }
    execution_.output.reply(request, std::move(answer));
}

}  // namespace wall::tileserver
