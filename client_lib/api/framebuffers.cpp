// SPDX-License-Identifier: MIT
// Framebuffer objects: names, binding, attachments, status (OpenGL 4.6, 9.2 and 9.4). The order of the checks is Mesa's
// (fbobject.c).
#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "client_lib/context/forget_objects.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"

namespace wall::client::api {
namespace {

using glstate::kColorAttachments;

/// The framebuffer that is bound to a target, to be changed. Null, and an error: no such target, or none is bound.
std::shared_ptr<Framebuffer> framebuffer_to_change(Context& c, GLenum target) {
    const auto* binding = framebuffer_binding(c, target);
    if (!binding) c.error(GL_INVALID_ENUM);
    else if (!*binding) c.error(GL_INVALID_OPERATION);
    return binding ? *binding : nullptr;
}

/// Places of an attachment point: two for GL_DEPTH_STENCIL_ATTACHMENT. Empty, and an error: no such point.
std::vector<unsigned> places_of(Context& c, GLenum point) {
    if (point == GL_DEPTH_STENCIL_ATTACHMENT) return {kColorAttachments, kColorAttachments + 1};
    if (const auto place = glstate::attachment_place(point)) return {*place};
    const bool color = point >= GL_COLOR_ATTACHMENT0 && point <= GL_COLOR_ATTACHMENT0 + 31;
    c.error(color ? GL_INVALID_OPERATION : GL_INVALID_ENUM);
    return {};
}

void attach(Context& c, Framebuffer& framebuffer, std::span<const unsigned> places, const Attachment& attachment) {
    std::vector<Attachment> before;
    change_framebuffer(c, framebuffer, [&](Framebuffer& f) {
        for (const unsigned place : places) {
            before.push_back(f.at(place));
            f.attach(place, attachment);
        }
    });
    for (const Attachment& old : before) forget_orphan(c, old);
}

constexpr GLint kMostLayers = 2048;

/// What glFramebufferTexture* names, before its texture is looked for.
struct TextureImage {
    enum class By : std::uint8_t { dimensions, layer, all_layers };
    By by;
    unsigned dimensions;  ///< of the command, if it is by them
    GLenum image_target;
    GLuint texture;
    GLint level, layer;
};

/// Whether images of a target lie one behind another.
bool has_layers(const glapi::TextureTargetInfo& target) {
    return target.layers != 0 || target.first_face != 0 || glapi::spatial_dimensions_of(target) == 3;
}

GLenum image_target_error(const TextureImage& image, const Texture& texture) {
    if (image.by == TextureImage::By::all_layers)
        return glapi::dimensions_of(texture.info) != 0 ? GL_NO_ERROR : GL_INVALID_OPERATION;
    if (image.by == TextureImage::By::layer) return has_layers(texture.info) ? GL_NO_ERROR : GL_INVALID_OPERATION;
    const auto word = target_word(image.image_target);
    if (!word || word->is_proxy() || glapi::dimensions_of(*word->info) == 0) return GL_INVALID_ENUM;
    return word->info == &texture.info && word->has_images() &&
                   glapi::spatial_dimensions_of(*word->info) == image.dimensions
               ? GL_NO_ERROR
               : GL_INVALID_OPERATION;
}

/// Where it is attached, the texture's kind having been checked.
void place_image(Attachment& attachment, const TextureImage& image) {
    const glapi::TextureTargetInfo& info = attachment.texture->info;
    attachment.target = image.by == TextureImage::By::dimensions ? image.image_target : info.target;
    attachment.level = image.level;
    attachment.layered = image.by == TextureImage::By::all_layers && has_layers(info);
    if (image.by == TextureImage::By::layer && info.first_face != 0)
        attachment.target = glapi::image_target(info, static_cast<unsigned>(image.layer));
    else attachment.layer = image.layer;
}

void attach_texture(Context& c, GLenum target, GLenum point, const TextureImage& image) {
    const auto framebuffer = framebuffer_to_change(c, target);
    if (!framebuffer) return;
    Attachment attachment;
    if (image.texture != 0) {
        std::lock_guard lock(c.share().mutex);
        attachment.texture = c.share().textures.find(image.texture);
    }
    if (image.texture != 0 && !attachment.texture) return c.error(GL_INVALID_OPERATION);
    if (attachment.texture) {
        if (const GLenum error = image_target_error(image, *attachment.texture)) return c.error(error);
        const auto& info = attachment.texture->info;
        const GLint layers = info.first_face != 0 ? static_cast<GLint>(glapi::kCubeFaces) : kMostLayers;
        if (image.layer < 0 || image.layer >= layers) return c.error(GL_INVALID_VALUE);
        if (image.level < 0 || image.level >= level_count(c, info.target)) return c.error(GL_INVALID_VALUE);
        place_image(attachment, image);
    }
    const auto places = places_of(c, point);
    if (!places.empty()) attach(c, *framebuffer, places, attachment);
}

void delete_framebuffer(Context& c, GLuint name) {
    FramebufferUse& use = *c.framebuffers;
    const auto framebuffer = use.names.erase(name);
    if (!framebuffer) return;
    if (use.draw == framebuffer) bind_framebuffer(c, GL_DRAW_FRAMEBUFFER, nullptr);
    if (use.read == framebuffer) bind_framebuffer(c, GL_READ_FRAMEBUFFER, nullptr);
    for (unsigned place = 0; place < glstate::kAttachmentPoints; ++place)
        attach(c, *framebuffer, std::array{place}, {});
    c.forget_object(framebuffer->id);
    std::lock_guard lock(c.share().mutex);
    c.share().by_id.erase(framebuffer->id);
}

// ---- glGetFramebufferAttachmentParameteriv ----

GLint component_type(const TextureFormat& format) {
    return static_cast<GLint>(format.base == GL_STENCIL_INDEX ? GLenum{GL_INDEX} : format.component_type);
}

/// Of an image; false: no such word.
bool shape_value(const ImageShape& shape, GLenum pname, GLint* value) {
    switch (pname) {
        case GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE: *value = shape.bits.red; return true;
        case GL_FRAMEBUFFER_ATTACHMENT_GREEN_SIZE: *value = shape.bits.green; return true;
        case GL_FRAMEBUFFER_ATTACHMENT_BLUE_SIZE: *value = shape.bits.blue; return true;
        case GL_FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE: *value = shape.bits.alpha; return true;
        case GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE: *value = shape.bits.depth; return true;
        case GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE: *value = shape.bits.stencil; return true;
        case GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE: *value = component_type(*shape.format); return true;
        case GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING: *value = shape.format->srgb ? GL_SRGB : GL_LINEAR; return true;
        default: return false;
    }
}

/// False: no such word for what is attached.
bool attachment_value(const Attachment& attachment, GLenum pname, GLint* value) {
    const bool texture = attachment.texture != nullptr;
    switch (pname) {
        case GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE: *value = texture ? GL_TEXTURE : GL_RENDERBUFFER; return true;
        case GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME: *value = static_cast<GLint>(attachment.object()->name); return true;
        case GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL: *value = attachment.level; return texture;
        case GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_CUBE_MAP_FACE:
            *value = texture && attachment.texture->info.first_face != 0 && !attachment.layered
                         ? static_cast<GLint>(attachment.target)
                         : 0;
            return texture;
        case GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LAYER: *value = attachment.layer; return texture;
        case GL_FRAMEBUFFER_ATTACHMENT_LAYERED: *value = attachment.layered; return texture;
        default: break;
    }
    const auto shape = shape_of(attachment);
    static constexpr TextureFormat kNone{.component_type = GL_UNSIGNED_NORMALIZED};
    return shape_value(shape.value_or(ImageShape{.format = &kNone}), pname, value);
}

/// Of the window's buffers.
void window_value(Context& c, GLenum point, GLenum pname, GLint* value) {
    const ComponentBits bits = draw_target_bits(c);
    const bool depth = point == GL_DEPTH, stencil = point == GL_STENCIL;
    const bool color = point >= GL_FRONT_LEFT && point <= GL_BACK;
    if (!depth && !stencil && !color) return c.error(GL_INVALID_ENUM);
    const bool there = depth ? bits.depth != 0 : stencil ? bits.stencil != 0 : true;
    static constexpr TextureFormat kColor{GL_RGBA8, GL_RGBA, GL_RGBA8, {}, GL_UNSIGNED_NORMALIZED, ImageUse::drawn};
    static constexpr TextureFormat kStencil{GL_STENCIL_INDEX, GL_STENCIL_INDEX, GL_STENCIL_INDEX, {}, 0,
                                            ImageUse::drawn};
    ImageShape shape{.format = stencil ? &kStencil : &kColor, .bits = bits};
    if (color) shape.bits.depth = shape.bits.stencil = 0;
    if (color && c.draw_target() && c.draw_target().encodes_srgb()) shape.format = find_texture_format(GL_SRGB8_ALPHA8);
    if (pname == GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) *value = there ? GL_FRAMEBUFFER_DEFAULT : GL_NONE;
    else if (pname == GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME) *value = 0;
    else if (!there) c.error(GL_INVALID_OPERATION);
    else if (!shape_value(shape, pname, value)) c.error(GL_INVALID_ENUM);
}

}  // namespace

void GenFramebuffers(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const GLuint first = c.framebuffers->names.reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; names && i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteFramebuffers(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    c.flush_block();
    for (GLsizei i = 0; i < count; ++i)
        if (names[i] != 0) delete_framebuffer(c, names[i]);
}

GLboolean IsFramebuffer(Context& c, GLuint name) { return name != 0 && c.framebuffers->names.find(name) != nullptr; }

// A name need not have been generated: what GL_EXT_framebuffer_object said, Mesa lets all compatibility contexts do.
void BindFramebuffer(Context& c, GLenum target, GLuint name) {
    if (!framebuffer_binding(c, target)) return c.error(GL_INVALID_ENUM);
    if (name == 0) return bind_framebuffer(c, target, nullptr);
    auto& names = c.framebuffers->names;
    auto framebuffer = names.find(name);
    if (!framebuffer) {
        if (c.profile.core && !names.known(name)) return c.error(GL_INVALID_OPERATION);
        framebuffer = std::make_shared<Framebuffer>(name, c.profile.es);
        names.put(name, framebuffer);
        std::lock_guard lock(c.share().mutex);
        c.share().by_id[framebuffer->id] = framebuffer;
    }
    bind_framebuffer(c, target, std::move(framebuffer));
}

GLenum CheckFramebufferStatus(Context& c, GLenum target) {
    const auto* binding = framebuffer_binding(c, target);
    if (!binding) return c.error(GL_INVALID_ENUM), GLenum{0};
    if (!*binding) return c.has_no_surface() ? GL_FRAMEBUFFER_UNDEFINED : GL_FRAMEBUFFER_COMPLETE;
    std::lock_guard lock(c.share().mutex);
    return (*binding)->status();
}

void FramebufferTexture1D(Context& c, GLenum target, GLenum point, GLenum image_target, GLuint texture, GLint level) {
    attach_texture(c, target, point, {TextureImage::By::dimensions, 1, image_target, texture, level, 0});
}
void FramebufferTexture2D(Context& c, GLenum target, GLenum point, GLenum image_target, GLuint texture, GLint level) {
    attach_texture(c, target, point, {TextureImage::By::dimensions, 2, image_target, texture, level, 0});
}
void FramebufferTexture3D(Context& c, GLenum target, GLenum point, GLenum image_target, GLuint texture, GLint level,
                          GLint layer) {
    attach_texture(c, target, point, {TextureImage::By::dimensions, 3, image_target, texture, level, layer});
}
void FramebufferTextureLayer(Context& c, GLenum target, GLenum point, GLuint texture, GLint level, GLint layer) {
    attach_texture(c, target, point, {TextureImage::By::layer, 0, GL_NONE, texture, level, layer});
}
void FramebufferTexture(Context& c, GLenum target, GLenum point, GLuint texture, GLint level) {
    attach_texture(c, target, point, {TextureImage::By::all_layers, 0, GL_NONE, texture, level, 0});
}

void FramebufferRenderbuffer(Context& c, GLenum target, GLenum point, GLenum renderbuffer_target, GLuint name) {
    if (!framebuffer_binding(c, target) || renderbuffer_target != GL_RENDERBUFFER) return c.error(GL_INVALID_ENUM);
    const auto framebuffer = framebuffer_to_change(c, target);
    if (!framebuffer) return;
    Attachment attachment;
    if (name != 0) {
        std::lock_guard lock(c.share().mutex);
        attachment.renderbuffer = c.share().renderbuffers.find(name);
    }
    if (name != 0 && !attachment.renderbuffer) return c.error(GL_INVALID_OPERATION);
    const auto places = places_of(c, point);
    if (!places.empty()) attach(c, *framebuffer, places, attachment);
}

// ---- without attachments (GL_ARB_framebuffer_no_attachments; OpenGL 4.3, 9.2.1) ----

namespace {

/// A parameter, the most that it may be, here and by what nodes say, and where it is kept.
struct DefaultParameter {
    GLenum word;
    std::uint32_t most;
    GLenum limit;
    std::uint32_t glstate::FramebufferDefaults::*field;
};
constexpr DefaultParameter kDefaultParameters[] = {
    {GL_FRAMEBUFFER_DEFAULT_WIDTH, glstate::kMostDefaultSize, GL_MAX_FRAMEBUFFER_WIDTH,
     &glstate::FramebufferDefaults::width},
    {GL_FRAMEBUFFER_DEFAULT_HEIGHT, glstate::kMostDefaultSize, GL_MAX_FRAMEBUFFER_HEIGHT,
     &glstate::FramebufferDefaults::height},
    {GL_FRAMEBUFFER_DEFAULT_LAYERS, glstate::kMostDefaultLayers, GL_MAX_FRAMEBUFFER_LAYERS,
     &glstate::FramebufferDefaults::layers},
    {GL_FRAMEBUFFER_DEFAULT_SAMPLES, glstate::kMostDefaultSamples, GL_MAX_FRAMEBUFFER_SAMPLES,
     &glstate::FramebufferDefaults::samples},
    {GL_FRAMEBUFFER_DEFAULT_FIXED_SAMPLE_LOCATIONS, ~std::uint32_t{0}, GL_NONE,
     &glstate::FramebufferDefaults::fixed_places},
};
const DefaultParameter* find_default(GLenum word) {
    const auto* found = std::ranges::find(kDefaultParameters, word, &DefaultParameter::word);
    return found != std::end(kDefaultParameters) ? found : nullptr;
}

/// Of a window as well.
std::optional<GLint> visual_value(Context& c, GLenum word) {
    switch (word) {
        case GL_DOUBLEBUFFER: return c.draw_target() && c.draw_target().format().double_buffered;
        case GL_STEREO: return c.draw_target() && c.draw_target().format().stereo;
        case GL_SAMPLES:
        case GL_SAMPLE_BUFFERS: {
            GLint value = 0;
            GetIntegerv(c, word, &value);
            return value;
        }
        case GL_IMPLEMENTATION_COLOR_READ_FORMAT:
        case GL_IMPLEMENTATION_COLOR_READ_TYPE: {
            GLint value = 0;
            GetIntegerv(c, word, &value);
            return value;
        }
        default: return std::nullopt;
    }
}

}  // namespace

void FramebufferParameteri(Context& c, GLenum target, GLenum pname, GLint param) {
    const auto* binding = framebuffer_binding(c, target);
    const DefaultParameter* parameter = find_default(pname);
    if (!binding || !parameter) return c.error(GL_INVALID_ENUM);
    const auto framebuffer = *binding;
    if (!framebuffer) return c.error(GL_INVALID_OPERATION);
    if (param < 0 && parameter->most != ~std::uint32_t{0}) return c.error(GL_INVALID_VALUE);
    auto value = static_cast<std::uint32_t>(param);
    if (value > parameter->most || value > limit_of(c.caps(), parameter->limit, parameter->most))
        return c.error(GL_INVALID_VALUE);
    if (pname == GL_FRAMEBUFFER_DEFAULT_FIXED_SAMPLE_LOCATIONS) value = value != 0;
    glstate::FramebufferDefaults defaults = framebuffer->defaults();
    defaults.*parameter->field = value;
    change_framebuffer(c, *framebuffer, [&](Framebuffer& f) { f.set_defaults(defaults); });
}

void GetFramebufferParameteriv(Context& c, GLenum target, GLenum pname, GLint* param) {
    const auto* binding = framebuffer_binding(c, target);
    if (!binding) return c.error(GL_INVALID_ENUM);
    if (const DefaultParameter* parameter = find_default(pname)) {
        if (!*binding) return c.error(GL_INVALID_OPERATION);
        *param = static_cast<GLint>((*binding)->defaults().*parameter->field);
    } else if (const auto value = visual_value(c, pname)) {
        *param = *value;
    } else {
        c.error(GL_INVALID_ENUM);
    }
}

void GetFramebufferAttachmentParameteriv(Context& c, GLenum target, GLenum point, GLenum pname, GLint* value) {
    const auto* binding = framebuffer_binding(c, target);
    if (!binding) return c.error(GL_INVALID_ENUM);
    if (!*binding) return window_value(c, point, pname, value);
    const auto places = places_of(c, point);
    if (places.empty()) return;
    std::lock_guard lock(c.share().mutex);
    const Attachment& attachment = (*binding)->at(places.front());
    if (places.size() == 2 && (*binding)->at(places.back()).object() != attachment.object())
        return c.error(GL_INVALID_OPERATION);
    if (attachment.present()) {
        if (!attachment_value(attachment, pname, value)) c.error(GL_INVALID_ENUM);
        return;
    }
    if (pname == GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) *value = GL_NONE;
    else if (pname == GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME) *value = 0;
    else c.error(GL_INVALID_OPERATION);
}

}  // namespace wall::client::api
