// SPDX-License-Identifier: MIT
#include "tileserver/execute/image_copy_commands.h"

#include <algorithm>
#include <array>

#include "common/glapi/texture_target.h"
#include "tileserver/objects/renderbuffer.h"
#include "tileserver/objects/texture.h"

namespace wall::tileserver {
namespace {

constexpr std::int32_t kMaxLevel = 14;

bool sane(std::int32_t at) { return at >= 0 && at <= kMaxImageSide; }

/// Of that target, by its own word; null: the session has none.
Texture* find_texture(const SessionReplica& session, ClientName name, GLenum target) {
    const auto word = glapi::find_target_word(target);
    if (!name || !word || !word->is_object()) return nullptr;
    Texture* texture = session.objects.find<Texture>(ObjectKey(name));
    return texture != nullptr && texture->target() == word->info->id ? texture : nullptr;
}

}  // namespace

// Mesa 22.3 looks at each face of a cube map before it looks whether there are as many.
std::optional<GLuint> ImageCopyCommands::find(const Place& place, std::int32_t depth, bool written) {
    const auto refuse = [&](const std::string& why) {
        execution_.refuse(why);
        return std::nullopt;
    };
    if (!sane(place.x) || !sane(place.y) || !sane(place.z) || place.level < 0 || place.level > kMaxLevel)
        return refuse("no such place in an image");
    if (place.target == GL_RENDERBUFFER) {
        const auto* renderbuffer = execution_.session.objects.find<Renderbuffer>(place.name);
        if (renderbuffer == nullptr) return refuse("no such renderbuffer");
        return renderbuffer->name();
    }
    Texture* texture = find_texture(execution_.session, place.name, place.target);
    if (texture == nullptr) return refuse("no such texture");
    if (glapi::info_of(texture->target()).first_face != 0 &&
        place.z + depth > static_cast<std::int32_t>(glapi::kCubeFaces))
        return refuse("no such face");
    if (written && texture->promise) return refuse("content under a name is not copied");
    if (written && !texture->own(execution_.node.shared)) return refuse(too_much("texture memory"));
    return texture->content().name();
}

void ImageCopyCommands::CopyImage(ClientName source, GLenum source_target, std::int32_t source_level,
                                  std::int32_t source_x, std::int32_t source_y, std::int32_t source_z, ClientName dest,
                                  GLenum dest_target, std::int32_t dest_level, std::int32_t dest_x, std::int32_t dest_y,
                                  std::int32_t dest_z, std::int32_t width, std::int32_t height, std::int32_t depth) {
    if (block_.in_begin) return execution_.refuse("between Begin and End");
    if (!sane(width) || !sane(height) || !sane(depth)) return execution_.refuse("absurd size");
    const auto to = find({dest, dest_target, dest_level, dest_x, dest_y, dest_z}, depth, true);
    const auto from = find({source, source_target, source_level, source_x, source_y, source_z}, depth, false);
    if (!to || !from || !block_.draws) return;
    execution_.gl.CopyImageSubData(*from, source_target, source_level, source_x, source_y, source_z, *to, dest_target,
                                   dest_level, dest_x, dest_y, dest_z, width, height, depth);
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
}

void ImageCopyCommands::ViewMipmaps(ClientName name, GLenum target, std::int32_t base, std::int32_t last) {
    if (block_.in_begin) return execution_.refuse("between Begin and End");
    if (base < 0 || base > kMaxLevel || last < 0 || last > kMaxLevel) return execution_.refuse("no such levels");
    Texture* texture = find_texture(execution_.session, name, target);
    if (texture == nullptr || !glapi::info_of(texture->target()).mipmaps)
        return execution_.refuse("no such texture or mipmaps");
    if (texture->promise) return execution_.refuse("content under a name has no mipmaps of a part");
    if (!texture->own(execution_.node.shared)) return execution_.refuse(too_much("texture memory"));
    if (!block_.draws) return;
    texture->content().make_mipmaps(base, last);
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
}

}  // namespace wall::tileserver
