// SPDX-License-Identifier: MIT
#include "tileserver/objects/texture_content.h"

#include <algorithm>
#include <vector>

#include "common/glapi/image.h"
#include "common/glapi/texture_target.h"

namespace wall::tileserver {

TextureContent::TextureContent(Driver& driver, TextureTarget target)
    : SharedContent(kKind), driver_(driver), target_(target) {
    driver.gl().CreateTextures(gl_target(target), 1, &name_);
}

// The driver gives a target to none but a new name.
TextureContent::TextureContent(Driver& driver, TextureTarget target, const TextureContent& origin, const Part& part)
    : SharedContent(kKind), driver_(driver), target_(target), part_(part), origin_(origin.name_) {
    driver.gl().GenTextures(1, &name_);
    driver.gl().TextureView(name_, gl_target(target), origin.name_, part.internal_format, part.first_level, part.levels,
                            part.first_layer, part.layers);
}

TextureContent::~TextureContent() {
    driver_.forget_texture(name_);
    driver_.gl().DeleteTextures(1, &name_);
}

namespace {

/// Of an image of the bound texture, as the driver has it; all 0: it has none.
struct DriverImage {
    ImageExtent extent;
    GLint compressed_bytes = 0;  ///< 0: it is not compressed
    GLint texel_bits = 0;        ///< of all samples together
};

DriverImage driver_image(const Gl& gl, GLenum image_target, GLint level) {
    DriverImage image;
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_WIDTH, &image.extent.width);
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_HEIGHT, &image.extent.height);
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_DEPTH, &image.extent.depth);
    for (const GLenum component :
         {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
          GL_TEXTURE_LUMINANCE_SIZE, GL_TEXTURE_INTENSITY_SIZE, GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE}) {
        GLint bits = 0;
        gl.GetTexLevelParameteriv(image_target, level, component, &bits);
        image.texel_bits += bits;
    }
    GLint samples = 0, compressed = 0;
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_SAMPLES, &samples);
    image.texel_bits *= std::max(samples, 1);
    gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_COMPRESSED, &compressed);
    if (compressed != 0)
        gl.GetTexLevelParameteriv(image_target, level, GL_TEXTURE_COMPRESSED_IMAGE_SIZE, &image.compressed_bytes);
    return image;
}

std::uint64_t estimate(const DriverImage& image) {
    if (image.compressed_bytes != 0) return static_cast<std::uint64_t>(image.compressed_bytes);
    // Drivers store texels of one to four bytes as four.
    const auto texel = std::max<std::uint64_t>((static_cast<std::uint64_t>(image.texel_bits) + 7) / 8, 4);
    return texel * static_cast<std::uint64_t>(image.extent.width) * static_cast<std::uint64_t>(image.extent.height) *
           static_cast<std::uint64_t>(image.extent.depth);
}

}  // namespace

void TextureContent::note_image(GLenum image_target, std::int32_t level, const ImageFormat* format) {
    const auto known = images_.find({image_target, level});
    if (format == nullptr && known == images_.end()) return;
    const Image now{format != nullptr ? *format : known->second.format,
                    estimate(driver_image(driver_.gl(), image_target, level))};
    bytes_ += now.bytes - (known == images_.end() ? 0 : known->second.bytes);
    images_[{image_target, level}] = now;
}

std::uint64_t TextureContent::image_bytes(GLenum image_target, std::int32_t level) const {
    const auto known = images_.find({image_target, level});
    return known == images_.end() ? 0 : known->second.bytes;
}

// Through the processor's memory, image by image, in the format of the definition: glCopyImageSubData would refuse
// incomplete textures. (glGetnTexImage of Mesa 22.3 writes nothing, and reports nothing.)
std::shared_ptr<TextureContent> TextureContent::copy() const {
    auto made = std::make_shared<TextureContent>(driver_, target_);
    made->images_ = images_;
    made->parameters_ = parameters_;
    made->whole_border_ = whole_border_;
    made->bytes_ = bytes_;
    driver_.neutral_pixel_transfer();
    driver_.bind_texture_to_edit(target_, made->name_);
    set_parameters(made->name_);
    const std::int32_t base_level = made_ ? made_->base : 0;
    for (const auto& [where, image] : images_)
        if (where.second == base_level) copy_image(where.first, where.second, image.format, *made);
    if (made_) made->make_mipmaps(made_->base, made_->last);
    driver_.bind_texture_to_edit(target_, made->name_);
    for (const auto& [where, image] : images_)
        if (where.second != base_level) copy_image(where.first, where.second, image.format, *made);
    return made;
}

std::shared_ptr<TextureContent> TextureContent::sized(GLsizei width, GLsizei height) const {
    if (part_ || images_.size() != 1) return nullptr;
    const auto& [where, image] = *images_.begin();
    const auto& [image_target, level] = where;
    if (level != 0 || image.format.compressed) return nullptr;
    auto made = std::make_shared<TextureContent>(driver_, target_);
    made->parameters_ = parameters_;
    made->whole_border_ = whole_border_;
    driver_.neutral_pixel_transfer();
    driver_.bind_texture_to_edit(target_, made->name_);
    set_parameters(made->name_);
    driver_.drain_errors();
    upload_image(driver_.gl(), target_, image_target, level, image.format, {width, height, 1}, nullptr);
    if (driver_.drain_errors() != 0) return nullptr;
    made->note_image(image_target, level, &image.format);
    return made;
}

void TextureContent::set_parameters(GLuint name) const {
    for (const auto& [pname, value] : parameters_) driver_.gl().TextureParameterfv(name, pname, value.data());
    if (whole_border_) driver_.gl().TextureParameterIiv(name, GL_TEXTURE_BORDER_COLOR, whole_border_->data());
}

GLuint TextureContent::Storage::layers(TextureTarget target) const {
    const glapi::TextureTargetInfo& info = glapi::info_of(target);
    if (info.first_face != 0) return glapi::kCubeFaces;
    if (info.layers == 0) return 1;
    return static_cast<GLuint>(glapi::spatial_dimensions_of(info) == 1 ? extent.height : extent.depth);
}

bool TextureContent::make_storage(GLuint name, const Storage& s) const {
    const Gl& gl = driver_.gl();
    const auto& [width, height, depth] = s.extent;
    const auto fixed = static_cast<GLboolean>(s.fixed_places);
    const unsigned dimensions = glapi::dimensions_of(glapi::info_of(target_));
    driver_.drain_errors();
    if (s.samples != 0 && dimensions == 3)
        gl.TextureStorage3DMultisample(name, s.samples, s.internal_format, width, height, depth, fixed);
    else if (s.samples != 0) gl.TextureStorage2DMultisample(name, s.samples, s.internal_format, width, height, fixed);
    else if (dimensions == 1) gl.TextureStorage1D(name, s.levels, s.internal_format, width);
    else if (dimensions == 2) gl.TextureStorage2D(name, s.levels, s.internal_format, width, height);
    else gl.TextureStorage3D(name, s.levels, s.internal_format, width, height, depth);
    return driver_.drain_errors() == 0;
}

// The driver takes an incomplete texture for none; what is left of this one is only its images.
void TextureContent::copy_levels(GLuint to) const {
    const Gl& gl = driver_.gl();
    const GLenum target = gl_target(target_);
    if (glapi::info_of(target_).mipmaps) {
        gl.TextureParameteri(name_, GL_TEXTURE_BASE_LEVEL, 0);
        gl.TextureParameteri(name_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    }
    const bool rows = glapi::spatial_dimensions_of(glapi::info_of(target_)) == 1;
    driver_.bind_texture_to_edit(target_, name_);
    for (const auto& [where, image] : images_) {
        const auto& [image_target, level] = where;
        const ImageExtent extent = driver_image(gl, image_target, level).extent;
        const auto face = static_cast<GLint>(glapi::find_target_word(image_target)->face);
        gl.CopyImageSubData(name_, target, level, 0, 0, face, to, target, level, 0, 0, face, extent.width,
                            rows ? 1 : extent.height, rows ? extent.height : extent.depth);
    }
}

void TextureContent::store(const Storage& storage) {
    if (storage_ || part_) return;
    const Gl& gl = driver_.gl();
    GLuint name = 0;
    gl.CreateTextures(gl_target(target_), 1, &name);
    if (!make_storage(name, storage)) return gl.DeleteTextures(1, &name);
    copy_levels(name);
    set_parameters(name);
    driver_.forget_texture(name_);
    gl.DeleteTextures(1, &name_);
    name_ = name;
    storage_ = storage;
    const ImageFormat format{storage.internal_format, GL_RGBA, GL_UNSIGNED_BYTE, false};
    driver_.bind_texture_to_edit(target_, name_);
    for (GLint level = 0; level < storage.levels; ++level)
        for (unsigned face = 0; face < glapi::face_count(glapi::info_of(target_)); ++face) {
            const GLenum image = glapi::image_target(glapi::info_of(target_), face);
            note_image(image, level, images_.contains({image, level}) ? nullptr : &format);
        }
}

bool TextureContent::has_level(std::int32_t level) const {
    if (part_) return level >= 0 && static_cast<GLuint>(level) < part_->levels;
    return images_.contains({glapi::image_target(glapi::info_of(target_), 0), level});
}

void TextureContent::make_mipmaps(std::int32_t base, std::int32_t last) {
    constexpr GLint kLast = 1000;
    if (!has_level(base)) return;  // Mesa 22.3 looks for it behind the levels that a texture may have
    const auto parameter = [&](GLenum pname, GLint otherwise) {
        const auto known = parameters_.find(pname);
        return known == parameters_.end() ? otherwise : static_cast<GLint>(known->second[0]);
    };
    made_ = Mipmaps{base, last};
    const Gl& gl = driver_.gl();
    gl.TextureParameteri(name_, GL_TEXTURE_BASE_LEVEL, base);
    gl.TextureParameteri(name_, GL_TEXTURE_MAX_LEVEL, last);
    gl.GenerateTextureMipmap(name_);
    gl.TextureParameteri(name_, GL_TEXTURE_BASE_LEVEL, parameter(GL_TEXTURE_BASE_LEVEL, 0));
    gl.TextureParameteri(name_, GL_TEXTURE_MAX_LEVEL, parameter(GL_TEXTURE_MAX_LEVEL, kLast));
}

// All sizes are the driver's: it writes as much as it has.
void TextureContent::copy_image(GLenum image_target, std::int32_t level, const ImageFormat& format,
                                const TextureContent& to) const {
    const Gl& gl = driver_.gl();
    driver_.bind_texture_to_edit(target_, name_);
    const DriverImage image = driver_image(gl, image_target, level);
    const ImageExtent& extent = image.extent;
    const std::uint64_t bytes =
        format.compressed
            ? static_cast<std::uint64_t>(image.compressed_bytes)
            : glapi::image_bytes(format.format, format.type, extent.width, extent.height, extent.depth).value_or(0);
    if (bytes == 0) return;
    std::vector<std::byte> pixels(bytes);
    if (format.compressed) gl.GetCompressedTexImage(image_target, level, pixels.data());
    else gl.GetTexImage(image_target, level, format.format, format.type, pixels.data());
    driver_.bind_texture_to_edit(target_, to.name_);
    if (format.compressed) upload_blocks(gl, target_, image_target, level, format.internal_format, extent, pixels);
    else upload_image(gl, target_, image_target, level, format, extent, pixels.data());
}

void upload_blocks(const Gl& gl, TextureTarget target, GLenum image_target, GLint level, GLenum internal_format,
                   const ImageExtent& extent, std::span<const std::byte> blocks) {
    const auto bytes = static_cast<GLsizei>(blocks.size());
    if (is_3d(target))
        gl.CompressedTexImage3D(image_target, level, internal_format, extent.width, extent.height, extent.depth, 0,
                                bytes, blocks.data());
    else
        gl.CompressedTexImage2D(image_target, level, internal_format, extent.width, extent.height, 0, bytes,
                                blocks.data());
}

void upload_stored_blocks(const Gl& gl, TextureTarget target, GLenum image_target, GLint level, GLenum internal_format,
                          const ImageExtent& extent, std::span<const std::byte> blocks) {
    const auto bytes = static_cast<GLsizei>(blocks.size());
    if (is_3d(target))
        gl.CompressedTexSubImage3D(image_target, level, 0, 0, 0, extent.width, extent.height, extent.depth,
                                   internal_format, bytes, blocks.data());
    else
        gl.CompressedTexSubImage2D(image_target, level, 0, 0, extent.width, extent.height, internal_format, bytes,
                                   blocks.data());
}

void upload_image(const Gl& gl, TextureTarget target, GLenum image_target, GLint level,
                  const TextureContent::ImageFormat& format, const ImageExtent& extent, const void* pixels,
                  GLint border) {
    const auto internal = static_cast<GLint>(format.internal_format);
    if (is_1d(target))
        gl.TexImage1D(image_target, level, internal, extent.width, border, format.format, format.type, pixels);
    else if (is_3d(target))
        gl.TexImage3D(image_target, level, internal, extent.width, extent.height, extent.depth, border, format.format,
                      format.type, pixels);
    else
        gl.TexImage2D(image_target, level, internal, extent.width, extent.height, border, format.format, format.type,
                      pixels);
}

}  // namespace wall::tileserver
