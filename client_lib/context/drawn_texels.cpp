// SPDX-License-Identifier: MIT
#include "client_lib/context/drawn_texels.h"

#include <algorithm>
#include <mutex>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/copied_parts.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/texture_view.h"

namespace wall::client {

namespace {

/// Mipmaps that the nodes' driver made, and blocks that the client keeps and cannot decode.
bool nodes_know_better(const TextureLevel& level) {
    return level.content == LevelContent::generated || (level.compressed && !is_s3tc(level.internal_format));
}

}  // namespace

std::optional<TexelData> drawn_texels(Context& c, const std::shared_ptr<Texture>& texture, unsigned face, GLint number,
                                      const char* function) {
    TextureLevel shape;  // without its pixels
    {
        std::lock_guard lock(c.share().mutex);
        refresh_view(*texture, face, number);
        const TextureLevel* level = texture->find_level(face, number);
        if (!level || (!texture->only_on_nodes(*level) && !nodes_know_better(*level))) return std::nullopt;
        shape.internal_format = level->internal_format;
        shape.format = level->format;
        shape.type = level->type;
        shape.width = level->width, shape.height = level->height, shape.depth = level->depth;
    }
    want_whole_images(c);
    const GLenum target = glapi::image_target(texture->info, face);
    const auto [format, type] = exact_pixels(shape);
    TexelData texels{format, type, {}};
    for_each_part(shape, [&](std::int32_t slice, std::int32_t first, std::int32_t rows) {
        const auto answer = ask_one_node(c, function, [&](wire::PackBuffer& buffer, RequestId request, Node& node) {
            {
                std::lock_guard lock(c.share().mutex);
                ObjectSender(c.session().nodes(), node, buffer).send(*texture);
            }
            glapi::pack::TexRead(buffer, request, texture->id, target, number, slice, first, rows, format, type);
        });
        const std::size_t bytes = glapi::image_bytes(format, type, shape.width, rows, 1).value_or(0);
        if (answer && answer->bytes.size() == bytes)
            texels.bytes.insert(texels.bytes.end(), answer->bytes.begin(), answer->bytes.end());
        else texels.bytes.resize(texels.bytes.size() + bytes);
    });
    return texels;
}

}  // namespace wall::client
