// SPDX-License-Identifier: MIT
#include "client_lib/objects/renderbuffer.h"

#include "gen/glapi/wire.gen.h"

namespace wall::client {

void Renderbuffer::define(std::uint32_t samples, GLenum internal_format, std::uint32_t width, std::uint32_t height) {
    samples_ = samples;
    internal_format_ = internal_format;
    width_ = width;
    height_ = height;
    stamp_ = next_stamp();
    drawn_ = false;
}

void Renderbuffer::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    glapi::pack::Renderbuffer(buffer, id, samples_, internal_format_, width_, height_);
    packed();
}

void Renderbuffer::pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer,
                              const std::function<void()>& packed) const {
    const TextureFormat* format = find_renderbuffer_format(internal_format_);
    if (!format) return;
    const auto [layout, type] = exact_pixels(*format, stored_bits(*format, GL_RGBA, GL_UNSIGNED_BYTE));
    for_each_rows(static_cast<std::int32_t>(width_), static_cast<std::int32_t>(height_),
                  [&](std::int32_t first, std::int32_t rows) {
                      const auto pixels = ask(
                          [&](wire::PackBuffer& question, RequestId request) {
                              glapi::pack::RenderbufferRead(question, request, id, first, rows, layout, type);
                          },
                          {first, rows, static_cast<std::int32_t>(width_)});
                      if (!pixels || pixels->empty()) return;
                      glapi::pack::RenderbufferWrite(buffer, id, first, rows, layout, type, *pixels);
                      packed();
                  });
}

namespace {

/// Also where the driver does not compress, after all.
bool asks_for_compression(GLenum internal_format) {
    return (internal_format >= GL_COMPRESSED_ALPHA && internal_format <= GL_COMPRESSED_RGBA) ||
           (internal_format >= GL_COMPRESSED_SRGB && internal_format <= GL_COMPRESSED_SLUMINANCE_ALPHA) ||
           internal_format == GL_COMPRESSED_RED || internal_format == GL_COMPRESSED_RG;
}

bool unsized_srgb(const TextureFormat& format) {
    return format.srgb && format.internal_format != GL_SRGB8 && format.internal_format != GL_SRGB8_ALPHA8;
}

}  // namespace

const TextureFormat* find_renderbuffer_format(GLenum internal_format) {
    static constexpr TextureFormat kStencil{
        GL_STENCIL_INDEX8, GL_STENCIL_INDEX, GL_STENCIL_INDEX8, {0, 0, 0, 0, 0, 0, 0, 8}, 0, ImageUse::drawn};
    if (internal_format >= GL_STENCIL_INDEX1 && internal_format <= GL_STENCIL_INDEX16) return &kStencil;
    if (internal_format == GL_STENCIL_INDEX) return &kStencil;
    if (internal_format <= 4 || asks_for_compression(internal_format)) return nullptr;
    const TextureFormat* format = find_texture_format(static_cast<GLint>(internal_format));
    return format && !format->compressed() && !unsized_srgb(*format) ? format : nullptr;
}

}  // namespace wall::client
