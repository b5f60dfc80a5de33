// SPDX-License-Identifier: MIT
#include "client_lib/context/drawn_texels.h"

#include <algorithm>
#include <mutex>

#include "client_lib/context/ask_one.h"
#include "client_lib/follow/object_sender.h"

namespace wall::client {

std::optional<std::vector<Rgba>> drawn_texels(Context& c, const std::shared_ptr<Texture>& texture, unsigned face,
                                              GLint number, const char* function) {
    TextureLevel shape;  // without its pixels
    {
        std::lock_guard lock(c.share().mutex);
        const TextureLevel* level = texture->find_level(face, number);
        if (!level || !texture->only_on_nodes(*level)) return std::nullopt;
        shape.internal_format = level->internal_format;
        shape.format = level->format;
        shape.type = level->type;
        shape.width = level->width, shape.height = level->height, shape.depth = level->depth;
    }
    const GLenum target = glapi::image_target(texture->info, face);
    const auto [format, type] = exact_pixels(shape);
    std::vector<Rgba> texels;
    for_each_part(shape, [&](std::int32_t slice, std::int32_t first, std::int32_t rows) {
        const auto answer = ask_one_node(c, function, [&](wire::PackBuffer& buffer, RequestId request, Node& node) {
            {
                std::lock_guard lock(c.share().mutex);
                ObjectSender(c.session().nodes(), node, buffer).send(*texture);
            }
            glapi::pack::TexRead(buffer, request, texture->id, target, number, slice, first, rows, format, type);
        });
        const std::size_t count = static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(rows);
        const auto part = answer && !answer->bytes.empty() ? to_rgba(format, type, answer->bytes, count)
                                                           : std::vector<Rgba>(count, Rgba{});
        texels.insert(texels.end(), part.begin(), part.end());
    });
    return texels;
}

}  // namespace wall::client
