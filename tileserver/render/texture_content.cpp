// SPDX-License-Identifier: MIT
#include "tileserver/render/texture_content.h"

#include <vector>

#include "common/glapi/image.h"

namespace wall::tileserver {
TextureContent::TextureContent(Driver& driver, TextureTarget target) : driver_(driver), target_(target) {
    driver.gl().CreateTextures(gl_target(target), 1, &name_);
}

TextureContent::~TextureContent() {
    driver_.forget_texture(name_);
    driver_.gl().DeleteTextures(1, &name_);
}

void TextureContent::note_image(GLenum image_target, std::int32_t level, const Image& image) {
    Image& known = images_[{image_target, level}];
    bytes_ += image.bytes - known.bytes;
    known = image;
}

// Through the processor's memory, image by image, in the format of the definition: glCopyImageSubData would refuse
// incomplete textures. (glGetnTexImage of Mesa 22.3 writes nothing, and reports nothing.)
std::shared_ptr<TextureContent> TextureContent::copy() const {
    const Gl& gl = driver_.gl();
    auto made = std::make_shared<TextureContent>(driver_, target_);
    made->images_ = images_;
    made->parameters_ = parameters_;
    made->bytes_ = bytes_;
    driver_.neutral_pixel_transfer();
    driver_.bind_texture_to_edit(target_, made->name_);
    for (const auto& [pname, value] : parameters_) gl.TexParameterfv(gl_target(target_), pname, value.data());
    const auto base = parameters_.find(GL_TEXTURE_BASE_LEVEL);
    const auto base_level = base == parameters_.end() ? 0 : static_cast<std::int32_t>(base->second[0]);
    for (const auto& [where, image] : images_)
        if (where.second == base_level) copy_image(where.first, where.second, image, *made);
    if (generated_) gl.GenerateMipmap(gl_target(target_));
    for (const auto& [where, image] : images_)
        if (where.second != base_level) copy_image(where.first, where.second, image, *made);
    return made;
}

void TextureContent::copy_image(GLenum image_target, std::int32_t level, const Image& image,
                                const TextureContent& to) const {
    const Gl& gl = driver_.gl();
    driver_.bind_texture_to_edit(target_, name_);
    ImageExtent extent;
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_WIDTH, &extent.width);
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_HEIGHT, &extent.height);
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_DEPTH, &extent.depth);
    const bool compressed = image.format == 0;
    const std::uint64_t bytes =
        compressed
            ? image.bytes
            : glapi::image_bytes(image.format, image.type, extent.width, extent.height, extent.depth).value_or(0);
    std::vector<std::byte> pixels(bytes);
    const auto size = static_cast<GLsizei>(bytes);
    if (bytes != 0 && compressed) gl.GetCompressedTexImage(image_target, level, pixels.data());
    if (bytes != 0 && !compressed) gl.GetTexImage(image_target, level, image.format, image.type, pixels.data());
    driver_.bind_texture_to_edit(target_, to.name_);
    if (compressed)
        gl.CompressedTexImage2D(image_target, level, image.internal_format, extent.width, extent.height, 0, size,
                                pixels.data());
    else upload_image(gl, target_, image_target, level, image, extent, pixels.data());
}

void upload_image(const Gl& gl, TextureTarget target, GLenum image_target, GLint level,
                  const TextureContent::Image& image, const ImageExtent& extent, const void* pixels, GLint border) {
    const auto internal = static_cast<GLint>(image.internal_format);
    if (is_1d(target))
        gl.TexImage1D(image_target, level, internal, extent.width, border, image.format, image.type, pixels);
    else if (is_3d(target))
        gl.TexImage3D(image_target, level, internal, extent.width, extent.height, extent.depth, border, image.format,
                      image.type, pixels);
    else
        gl.TexImage2D(image_target, level, internal, extent.width, extent.height, border, image.format, image.type,
                      pixels);
}

}  // namespace wall::tileserver
