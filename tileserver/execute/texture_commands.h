// SPDX-License-Identifier: MIT
// Group [texture]. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "tileserver/execute/content_question.h"
#include "tileserver/execute/execution.h"
#include "tileserver/objects/texture.h"

namespace wall::tileserver {

class TextureCommands {
public:
    /// Both outlive it.
    TextureCommands(Execution& execution, ContentQuestion& question) : execution_(execution), question_(question) {}

    void TexImage(ClientName texture, GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width,
                  std::int32_t height, std::int32_t depth, std::int32_t border, GLenum format, GLenum type,
                  std::span<const std::byte> pixels);
    void TexSubImage(ClientName texture, GLenum target, std::int32_t level, std::int32_t x, std::int32_t y,
                     std::int32_t z, std::int32_t width, std::int32_t height, std::int32_t depth, GLenum format,
                     GLenum type, std::span<const std::byte> pixels);
    void TexCompressed(ClientName texture, GLenum target, std::int32_t level, GLenum internal_format,
                       std::int32_t width, std::int32_t height, std::int32_t depth, std::span<const std::byte> blocks);
    void TexParameter(ClientName texture, GLenum target, GLenum pname, float p0, float p1, float p2, float p3);
    void TexBorderWhole(ClientName texture, GLenum target, std::int32_t p0, std::int32_t p1, std::int32_t p2,
                        std::int32_t p3);
    void TexImageSamples(ClientName texture, GLenum target, std::uint32_t samples, GLenum internal_format,
                         std::int32_t width, std::int32_t height, std::int32_t depth, std::uint32_t fixed_places);
    void ShareTexture(RequestId request, ClientName texture, GLenum target, std::uint32_t own_name,
                      std::span<const std::byte> key);
    void TexShared(ClientName texture);
    // Group [texture_view] (texture_view_commands.cpp): storage for good, which textures may be parts of.
    void TexStorage(ClientName texture, GLenum target, std::uint32_t levels, GLenum internal_format, std::int32_t width,
                    std::int32_t height, std::int32_t depth, std::uint32_t samples, std::uint32_t fixed_places);
    void TexView(ClientName texture, ClientName origin, GLenum target, GLenum internal_format,
                 std::uint32_t first_level, std::uint32_t levels, std::uint32_t first_layer, std::uint32_t layers);
    void Compress(RequestId request, GLenum internal_format, std::int32_t width, std::int32_t height, GLenum format,
                  GLenum type, std::span<const std::byte> pixels);

private:
    /// The texture to change: its own, bound for the driver's work on the object; null after a refusal.
    Texture* bind_to_edit(ClientName name, GLenum target);
    /// `define` calls the driver for an image of the bound texture; what the driver then has is noted.
    template <class Define>
    void define_image(Texture& texture, GLenum target, std::int32_t level, const TextureContent::ImageFormat& format,
                      Define&& define);
    void adopt(Texture& texture, std::shared_ptr<SharedContent> have);

    Execution& execution_;
    ContentQuestion& question_;
};

}  // namespace wall::tileserver
