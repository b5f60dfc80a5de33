// SPDX-License-Identifier: MIT
// Texture images (OpenGL 1.2.1, 3.8.1 and 3.8.2). They are stored as given, with tight rows, and sent when a node draws
// with the texture. Pixel transfer is applied here, so that what is stored does not depend on later state; nodes upload
// with neutral transfer. The order of the checks is Mesa's (teximage.c), so that the error is the same where two apply.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include "client_lib/context/copied_texels.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/context/readback.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/texture_formats.h"
#include "client_lib/objects/texture_view.h"
#include "client_lib/objects/view_formats.h"
#include "common/glapi/block_formats.h"

namespace wall::client {
namespace {

GLint largest_size(Context& c, const glapi::TextureTargetInfo& target) {
    return static_cast<GLint>(limit_of(c.caps(), target.size_limit, target.usual_size));
}

/// What an image call's word says; the word has been checked.
const glapi::TextureTargetInfo& info_of(const ImageCall& call) { return *target_word(call.target)->info; }

bool legal_target(unsigned dimensions, GLenum word) {
    const auto* target = image_target_of(word);
    return target && target->images == dimensions;
}

bool depth_like(GLenum format) { return format == GL_DEPTH_COMPONENT || format == GL_DEPTH_STENCIL; }

/// Colour pixels go into colour textures only, and so on.
bool formats_agree(const TextureFormat& internal, GLenum format) {
    if (depth_like(internal.base)) return depth_like(format);
    if (internal.base == GL_STENCIL_INDEX) return format == GL_STENCIL_INDEX;
    if (depth_like(format) || format == GL_STENCIL_INDEX) return false;
    return internal.whole() == glapi::is_integer_format(format);
}

/// Whether nodes make its texels of pixels; a format of blocks may be one that they only take as such.
bool is_compressed_online(const TextureFormat& internal) {
    return !glapi::is_only_given(static_cast<GLenum>(internal.internal_format));
}

GLint most_layers(Context& c) { return static_cast<GLint>(limit_of(c.caps(), GL_MAX_ARRAY_TEXTURE_LAYERS, 2048)); }

}  // namespace

bool legal_size(Context& c, const ImageCall& call) {
    const glapi::TextureTargetInfo& target = info_of(call);
    const GLint most = std::max(largest_size(c, target) >> call.level, 1);
    const std::array sizes{call.width, call.height, call.depth};
    const unsigned spatial = glapi::spatial_dimensions_of(target);
    for (unsigned i = 0; i < spatial; ++i)
        if (sizes[i] < 0 || sizes[i] > most) return false;
    if (target.square && call.width != call.height) return false;
    return target.layers == 0 ||
           (sizes[spatial] >= 0 && sizes[spatial] <= most_layers(c) && sizes[spatial] % target.layers == 0);
}

namespace {

GLint most_border(const Context& c, const ImageCall& call) { return info_of(call).mipmaps && !c.profile.core ? 1 : 0; }

/// Null: no such internal format, or none in the context's profile.
const TextureFormat* format_named(const Context& c, GLint internal_format) {
    const bool removed = c.profile.core && internal_format <= 4;  // numbers of components
    return removed || is_removed(c, static_cast<GLenum>(internal_format)) ? nullptr
                                                                          : find_texture_format(internal_format);
}

GLenum image_error(Context& c, const ImageCall& call, const TextureFormat* internal) {
    if (call.level < 0 || call.level >= level_count(c, call.target)) return GL_INVALID_VALUE;
    if (call.border < 0 || call.border > most_border(c, call)) return GL_INVALID_VALUE;
    if (call.width < 0 || call.height < 0 || call.depth < 0) return GL_INVALID_VALUE;
    if (const GLenum error = glapi::format_type_error(call.format, call.type)) return error;
    if (!internal) return GL_INVALID_VALUE;
    if (!formats_agree(*internal, call.format)) return GL_INVALID_OPERATION;
    if (!is_compressed_online(*internal)) return GL_INVALID_OPERATION;
    const bool volume = glapi::spatial_dimensions_of(info_of(call)) == 3;
    if (volume && (depth_like(internal->base) || internal->base == GL_STENCIL_INDEX)) return GL_INVALID_OPERATION;
    const auto blocks = static_cast<GLenum>(internal->internal_format);  // not what a driver chooses
    if (volume && glapi::block_bytes(blocks) != 0 && !glapi::is_for_volumes(blocks)) return GL_INVALID_OPERATION;
    return GL_NO_ERROR;
}

// Gallium's drivers have no borders: Mesa drops the outermost texels, and so do we.
void strip_border(ImageCall& call) {
    if (call.border == 0) return;
    if (call.store.row_length == 0) call.store.row_length = call.width;
    if (call.store.image_height == 0) call.store.image_height = call.height;
    call.store.skip_pixels += 1;
    const unsigned spatial = glapi::spatial_dimensions_of(info_of(call));
    call.width = std::max(0, call.width - 2);
    if (spatial > 1) call.store.skip_rows += 1, call.height = std::max(0, call.height - 2);
    if (spatial > 2) call.store.skip_images += 1, call.depth = std::max(0, call.depth - 2);
    call.border = 0;
}

std::size_t texels(const ImageCall& call) {
    return static_cast<std::size_t>(call.width) * static_cast<std::size_t>(call.height) *
           static_cast<std::size_t>(call.depth);
}

std::size_t texels_in(const TexBox& box) {
    return static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height) *
           static_cast<std::size_t>(box.depth);
}

/// More than nodes hold in one level.
bool too_large(const ImageCall& call) { return texels(call) > kMostTexels; }

template <class T>
std::vector<std::byte> bytes_of(const std::vector<T>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

TexelData transferred(Context& c, const ImageCall& call, TexelData data) {
    if (!transfer_matters(c.state, call.format)) return data;
    const PixelMapTables& maps = c.maps->pixel;
    if (call.format == GL_DEPTH_STENCIL) return data;
    if (call.format == GL_COLOR_INDEX) {
        const auto indices = to_indices(call.type, data.bytes, call.width, call.height * call.depth);
        return {GL_RGBA, GL_FLOAT, bytes_of(indices_to_colors(c.state, maps, indices))};
    }
    auto pixels = to_rgba(data.format, data.type, data.bytes, texels(call));
    if (call.format == GL_DEPTH_COMPONENT) {
        transfer_depths(c.state, pixels);
        return {GL_DEPTH_COMPONENT, GL_FLOAT, from_rgba(GL_DEPTH_COMPONENT, GL_FLOAT, pixels)};
    }
    transfer_colors(c.state, maps, pixels);
    return {GL_RGBA, GL_FLOAT, bytes_of(pixels)};
}

TexelData unpacked(Context& c, const ImageCall& call) {
    const glapi::ImageSize size{call.width, call.height, call.depth, call.dimensions};
    return transferred(
        c, call, {call.format, call.type, glapi::unpack_image(call.store, size, call.format, call.type, call.pixels)});
}

/// In the buffer object if one is bound. False: not there, and the error is recorded.
bool find_pixels(Context& c, ImageCall& call) {
    if (!c.state.local.pixel_unpack_buffer) return true;
    const glapi::ImageSize size{call.width, call.height, call.depth, call.dimensions};
    call.pixels = image_source(c, {size, call.format, call.type}, call.pixels);
    return call.pixels != nullptr;
}

bool eight_bits(GLenum format, GLenum type) { return type == GL_UNSIGNED_BYTE && !depth_like(format); }

void convert(TexelData& data, std::size_t count, GLenum format, GLenum type) {
    data.bytes = glapi::is_integer_format(format)
                     ? from_whole(format, type, to_whole(data.format, data.type, data.bytes, count))
                     : from_rgba(format, type, to_rgba(data.format, data.type, data.bytes, count));
    data.format = format;
    data.type = type;
}

/// One that holds all that a level may have, whatever it came as.
PixelKind common_kind(const TextureLevel& level, const TexelData& data) {
    if (level.data_format == GL_STENCIL_INDEX) return {GL_STENCIL_INDEX, GL_UNSIGNED_BYTE};
    if (depth_like(level.data_format)) return {GL_DEPTH_COMPONENT, GL_FLOAT};
    if (glapi::is_integer_format(level.data_format)) return exact_pixels(level);
    const bool bytes = eight_bits(level.data_format, level.data_type) && eight_bits(data.format, data.type);
    return {GL_RGBA, bytes ? GLenum{GL_UNSIGNED_BYTE} : GLenum{GL_FLOAT}};
}

/// Brings a level's pixels and new ones to one format.
void unify(TextureLevel& level, TexelData& data, std::size_t count) {
    if (level.data_format == data.format && level.data_type == data.type) return;
    const auto [format, type] = common_kind(level, data);
    TexelData old{level.data_format, level.data_type, std::move(level.pixels)};
    const std::size_t all = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) *
                            static_cast<std::size_t>(level.depth);
    convert(old, all, format, type);
    convert(data, count, format, type);
    level.pixels = std::move(old.bytes);
    level.data_format = format;
    level.data_type = type;
}

void copy_box(TextureLevel& level, const TexBox& box, const std::vector<std::byte>& from) {
    const auto layout = *glapi::pixel_layout(level.data_format, level.data_type);
    const std::size_t row = glapi::row_bytes(layout, level.width), bytes = glapi::row_bytes(layout, box.width);
    const std::byte* at = from.data();
    for (GLint z = 0; z < box.depth; ++z)
        for (GLint y = 0; y < box.height; ++y, at += bytes) {
            const auto line = static_cast<std::size_t>(box.z + z) * static_cast<std::size_t>(level.height) +
                              static_cast<std::size_t>(box.y + y);
            std::memcpy(level.pixels.data() + line * row + static_cast<std::size_t>(box.x) * layout.pixel_bytes, at,
                        bytes);
        }
}

}  // namespace

bool is_immutable(Context& c, GLenum target) {
    const auto texture = bound_texture(c, target);
    return texture && texture->immutable_levels != 0;
}

void generate_if_asked(Texture& texture, GLint level) {
    if (texture.view.origin) return;  // which keeps the texels; it is not asked
    if (texture.parameters.generate_mipmap && level == texture.parameters.base_level) texture.mipmaps_generated();
}

GLint level_count(Context& c, GLenum target) {
    const glapi::TextureTargetInfo& info = *target_word(target)->info;
    return info.mipmaps ? std::bit_width(static_cast<unsigned>(largest_size(c, info))) : 1;
}

namespace {

/// In OpenGL ES depths of formats with a size are red (OpenGL ES 3.0.6, 3.8.15), others gray (OES_depth_texture).
void set_depth_mode(Texture& texture, const ImageCall& call) {
    const TextureFormat* format = find_texture_format(call.internal_format);
    const GLenum mode = call.unsized_depth ? GL_LUMINANCE : GL_RED;
    if (!format || !depth_like(format->base) || std::exchange(texture.parameters.depth_mode, mode) == mode) return;
    texture.parameter_changed(GL_DEPTH_TEXTURE_MODE);
}

}  // namespace

void store_level(Context& c, const ImageCall& call, TexelData data) {
    const auto texture = texture_to_change(c, call.target);
    std::lock_guard lock(c.share().mutex);
    if (c.profile.is_es()) set_depth_mode(*texture, call);
    TextureLevel& level = texture->level_at(face_of(call.target), call.level);
    level = TextureLevel{};
    level.internal_format = call.internal_format;
    level.width = call.width;
    level.height = call.height;
    level.depth = call.depth;
    const bool index = call.format == GL_COLOR_INDEX;
    level.format = index ? GL_RGBA : call.format;
    level.type = index ? GL_FLOAT : call.type;
    level.data_format = data.format;
    level.data_type = data.type;
    level.content = call.pixels ? LevelContent::stored : LevelContent::none;
    level.pixels = std::move(data.bytes);
    level.stamp = next_stamp();
    generate_if_asked(*texture, call.level);
    touch(c.share(), *texture);
}

void change_level(Context& c, const ImageCall& call, TexelData data) {
    const auto texture = texture_to_change(c, call.target);
    if (texture->find_level(face_of(call.target), call.level)->compressed) {
        if (!change_blocks(c, call, data)) c.error(GL_OUT_OF_MEMORY);
        return;
    }
    if (texture->view.origin) c.before_change(texture->view.origin->id);
    std::lock_guard lock(c.share().mutex);
    put_texels(c.share(), *texture, face_of(call.target), call.level,
               {call.x, call.y, call.z, call.width, call.height, call.depth, 0}, std::move(data));
    generate_if_asked(*texture, call.level);
    touch(c.share(), *texture);
}

void before_texels_change(Context& c, const Texture& texture) {
    c.flush_block();
    c.before_change(texture.id);
    if (texture.view.origin) c.before_change(texture.view.origin->id);
}

namespace {

/// Of a texture that keeps its texels itself.
void put_own_texels(Texture& texture, unsigned face, GLint number, TexBox box, TexelData data) {
    TextureLevel& level = *texture.find_level(face, number);
    if (texture.only_on_nodes(level)) level.content = LevelContent::drawn;
    const bool partial = level.content == LevelContent::drawn;
    if (partial ? level.pixels.empty() : level.content != LevelContent::stored) {
        const auto whole = glapi::image_bytes(data.format, data.type, level.width, level.height, level.depth);
        level.pixels.assign(whole.value_or(0), std::byte{0});
        level.data_format = data.format;
        level.data_type = data.type;
        if (level.content == LevelContent::generated) level.stamp = next_stamp();
        if (!partial) level.content = LevelContent::stored;
    }
    unify(level, data, texels_in(box));
    box.stamp = next_stamp();
    copy_box(level, box, data.bytes);
    level.note_change(box);
}

/// Pixels of a view's format as those that are the same memory in its origin's.
TexelData as_kept(GLint seen, GLint kept, TexelData data, std::size_t count) {
    if (seen == kept) return data;
    const PixelKind as = find_view_format(seen)->texels, of = find_view_format(kept)->texels;
    return {of.format, of.type, converted_texels({data.format, data.type}, std::move(data.bytes), count, as)};
}

}  // namespace

void put_texels(ShareGroup& share, Texture& texture, unsigned face, GLint number, const TexBox& box, TexelData data) {
    if (!texture.view.origin) {
        put_own_texels(texture, face, number, box, std::move(data));
        return touch(share, texture);
    }
    Texture& origin = *texture.view.origin;
    const auto parts = kept_parts(texture, face, number, box);
    const std::size_t bytes = data.bytes.size() / parts.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const TextureLevel* kept = origin.find_level(parts[i].face, parts[i].level);
        if (!kept) continue;
        const auto from = data.bytes.begin() + static_cast<std::ptrdiff_t>(i * bytes);
        TexelData part{data.format, data.type, {from, from + static_cast<std::ptrdiff_t>(bytes)}};
        put_own_texels(origin, parts[i].face, parts[i].level, parts[i].box,
                       as_kept(texture.find_level(face, number)->internal_format, kept->internal_format,
                               std::move(part), texels_in(parts[i].box)));
    }
    touch(share, origin);
}

namespace {

/// Replaces what OpenGL ES has its own words for; the error if it does not have these pixels.
GLenum adopt_es_pixels(ImageCall& call, const EsImage& image) {
    call.type = image.type;
    return image.error;
}

/// Of what is to change a texture in OpenGL ES; nothing: there is no texture or image to change.
std::optional<EsImage> pixels_to_change(Context& c, const ImageCall& call) {
    const auto texture = target_word(call.target) ? bound_texture(c, call.target) : nullptr;
    const TextureLevel* level = texture ? texture->find_level(face_of(call.target), call.level) : nullptr;
    return level ? std::optional(es_pixels(c.profile.es, level->internal_format, call.format, call.type))
                 : std::nullopt;
}

}  // namespace

void define_image(Context& c, ImageCall call) {
    if (!legal_target(call.dimensions, call.target)) return c.error(GL_INVALID_ENUM);
    if (c.profile.is_es()) {
        const EsImage image = es_image(c.profile.es, call.internal_format, call.format, call.type);
        if (call.border != 0) return c.error(GL_INVALID_VALUE);
        if (const GLenum error = adopt_es_pixels(call, image)) return c.error(error);
        call.unsized_depth = depth_like(static_cast<GLenum>(call.internal_format));
        call.internal_format = image.internal_format;
    }
    const TextureFormat* internal = format_named(c, call.internal_format);
    const GLenum error = image_error(c, call, internal);
    if (is_proxy(call.target)) {
        if (error != GL_NO_ERROR) return c.error(error);
        strip_border(call);
        TextureLevel& level = c.maps->proxies[{call.target, call.level}];
        level = TextureLevel{};
        if (!legal_size(c, call) || too_large(call)) return;
        level.internal_format = call.internal_format;
        level.width = call.width, level.height = call.height, level.depth = call.depth;
        level.format = call.format, level.type = call.type;
        return;
    }
    if (error != GL_NO_ERROR) return c.error(error);
    if (is_immutable(c, call.target)) return c.error(GL_INVALID_OPERATION);
    if (!glapi::image_bytes(call.format, call.type, call.width, call.height, call.depth))
        return c.error(GL_OUT_OF_MEMORY);
    if (!find_pixels(c, call)) return;
    strip_border(call);
    if (!legal_size(c, call)) return c.error(GL_INVALID_VALUE);
    if (too_large(call)) return c.error(GL_OUT_OF_MEMORY);
    store_level(c, call, call.pixels ? unpacked(c, call) : TexelData{call.format, call.type, {}});
}

/// Of an image that the nodes compress.
bool whole_blocks(const ImageCall& part, const TextureLevel& level) {
    const auto block = block_size(level.internal_format);
    return is_whole_blocks(part.x, part.width, level.width, block.width) &&
           is_whole_blocks(part.y, part.height, level.height, block.height);
}

GLenum sub_image_error(Context& c, const ImageCall& call) {
    if (is_proxy(call.target) || !legal_target(call.dimensions, call.target)) return c.target_error;
    if (call.level < 0 || call.level >= level_count(c, call.target)) return GL_INVALID_VALUE;
    if (call.width < 0 || call.height < 0 || call.depth < 0) return GL_INVALID_VALUE;
    if (const GLenum error = glapi::format_type_error(call.format, call.type)) return error;
    const auto texture = bound_texture(c, call.target);
    const TextureLevel* level = texture ? texture->find_level(face_of(call.target), call.level) : nullptr;
    if (!level) return GL_INVALID_OPERATION;
    const auto inside = [](GLint at, GLsizei size, GLint all) { return at >= 0 && std::int64_t{at} + size <= all; };
    if (!inside(call.x, call.width, level->width) || !inside(call.y, call.height, level->height) ||
        !inside(call.z, call.depth, level->depth))
        return GL_INVALID_VALUE;
    if (blocks_format(level->internal_format) != 0 && !whole_blocks(call, *level)) return GL_INVALID_OPERATION;
    const TextureFormat* internal = find_texture_format(level->internal_format);
    if (internal && !is_compressed_online(*internal)) return GL_INVALID_OPERATION;
    return internal && formats_agree(*internal, call.format) ? GL_NO_ERROR : GL_INVALID_OPERATION;
}

void define_sub_image(Context& c, ImageCall call) {
    if (c.profile.is_es()) {
        const auto pixels = pixels_to_change(c, call);
        if (!pixels) call.type = desktop_type(call.type);
        else if (const GLenum error = adopt_es_pixels(call, *pixels)) return c.error(error);
    }
    change_sub_image(c, call);
}

void change_sub_image(Context& c, ImageCall call) {
    if (const GLenum error = sub_image_error(c, call)) return c.error(error);
    if (texels(call) == 0 || !find_pixels(c, call) || !call.pixels) return;
    change_level(c, call, unpacked(c, call));
}

}  // namespace wall::client

namespace wall::client::api {
namespace {

ImageCall image_call(Context& c, unsigned dimensions, GLenum target, GLint level, GLenum format, GLenum type,
                     const void* pixels) {
    ImageCall call;
    call.dimensions = dimensions;
    call.target = target;
    call.level = level;
    call.format = format;
    call.type = type;
    call.pixels = pixels;
    call.store = unpack_store(c.state);
    return call;
}

/// What loses nothing that a texture of that format keeps.
PixelKind copied_kind(const TextureFormat& to) {
    if (depth_like(to.base))
        return {GL_DEPTH_COMPONENT, to.component_type == GL_FLOAT ? GLenum{GL_FLOAT} : GLenum{GL_UNSIGNED_INT}};
    if (to.whole()) return {GL_RGBA_INTEGER, to.component_type};
    const ComponentBits& b = to.bits;
    const bool bytes = to.component_type == GL_UNSIGNED_NORMALIZED &&
                       std::max({b.red, b.green, b.blue, b.alpha, b.luminance, b.intensity}) <= 8;
    return {GL_RGBA, bytes ? GLenum{GL_UNSIGNED_BYTE} : GLenum{GL_FLOAT}};
}

/// What to read from the framebuffer for a texture of this kind. Neutral: pixel transfer follows in store or change.
void set_copied_format(Context& c, ImageCall& call, const TextureFormat& to) {
    const PixelKind kind = copied_kind(to);
    call.format = kind.format;
    call.type = transfer_matters(c.state, call.format) ? GLenum{GL_FLOAT} : kind.type;
    call.store = {};
    call.store.alignment = 1;
}

/// Whole numbers are copied to the same kind of them, and to nothing else.
bool may_copy(Context& c, const TextureFormat& to) {
    if (depth_like(to.base)) return true;
    const TextureFormat* from = read_color_format(c);
    if (!from) return false;
    return from->whole() == to.whole() && (!to.whole() || from->component_type == to.component_type);
}

TexelData copied(Context& c, const ImageCall& call, GLint x, GLint y, const char* function) {
    auto bytes = gather_plain(c, {x, y, call.width, call.height}, call.format, call.type, function);
    return transferred(c, call, {call.format, call.type, std::move(bytes)});
}

struct From {
    GLint x, y;
};

/// The components of the colours that are read from.
GLenum read_base(Context& c) {
    if (!c.framebuffers->read && c.read_target()) return c.read_target().format().alpha_bits != 0 ? GL_RGBA : GL_RGB;
    const TextureFormat* format = read_color_format(c);
    return format ? format->base : GLenum{GL_NONE};
}

void copy_image(Context& c, ImageCall call, GLenum internal_format, From from, const char* function) {
    if (is_proxy(call.target) || !legal_target(call.dimensions, call.target)) return c.error(c.target_error);
    if (call.level < 0 || call.level >= level_count(c, call.target)) return c.error(GL_INVALID_VALUE);
    if (call.border < 0 || call.border > most_border(c, call)) return c.error(GL_INVALID_VALUE);
    const TextureFormat* internal = format_named(c, static_cast<GLint>(internal_format));
    if (!internal || internal_format <= 4) return c.error(GL_INVALID_ENUM);
    if (!is_compressed_online(*internal)) return c.error(GL_INVALID_OPERATION);
    if (!may_read_pixels(c)) return;
    if (c.profile.is_es()) {
        const TextureFormat* colors = read_color_format(c);
        const GLenum none = GL_INVALID_OPERATION,
                     error = colors ? es_copy_error(c.profile.es, internal_format, *colors, read_base(c)) : none;
        if (call.border != 0 || error != GL_NO_ERROR) return c.error(error ? error : GLenum{GL_INVALID_VALUE});
    }
    if (call.width < 0 || call.height < 0) return c.error(GL_INVALID_VALUE);
    call.internal_format = static_cast<GLint>(internal_format);
    from.x += call.border;
    if (call.dimensions > 1) from.y += call.border;
    strip_border(call);
    if (!legal_size(c, call)) return c.error(GL_INVALID_VALUE);
    if (is_immutable(c, call.target)) return c.error(GL_INVALID_OPERATION);
    if (!may_copy(c, *internal)) return c.error(GL_INVALID_OPERATION);
    set_copied_format(c, call, *internal);
    if (can_copy_on_nodes(c, call, *internal, stored_bits(*internal, call.format, call.type), from.x, from.y)) {
        store_level(c, call, {call.format, call.type, {}});
        return copy_on_nodes(c, call, from.x, from.y);
    }
    call.pixels = "";  // there will be some
    store_level(c, call, copied(c, call, from.x, from.y, function));
}

/// Texels that would come from outside of what is read from stay as they are, as Mesa has it (OpenGL 4.6, 18.2.1 says
/// nothing of them).
void clip_copy(Context& c, ImageCall& call, From& from) {
    const PixelBox inside = clip_to_window(c, {from.x, from.y, call.width, call.height});
    call.x += inside.x - from.x;
    call.y += inside.y - from.y;
    call.width = std::max(inside.width, 0);
    call.height = std::max(inside.height, 0);
    from = {inside.x, inside.y};
}

void copy_sub_image(Context& c, ImageCall call, From from, const char* function) {
    const auto texture = target_word(call.target) ? bound_texture(c, call.target) : nullptr;
    const TextureLevel* level = texture ? texture->find_level(face_of(call.target), call.level) : nullptr;
    const TextureFormat* internal = level ? find_texture_format(level->internal_format) : nullptr;
    if (internal) set_copied_format(c, call, *internal);
    if (!may_read_pixels(c)) return;
    if (const GLenum error = sub_image_error(c, call)) return c.error(error);
    if (!may_copy(c, *internal)) return c.error(GL_INVALID_OPERATION);
    clip_copy(c, call, from);
    if (texels(call) == 0) return;
    if (can_copy_on_nodes(c, call, *internal, stored_bits(*internal, level->format, level->type), from.x, from.y))
        return copy_on_nodes(c, call, from.x, from.y);
    change_level(c, call, copied(c, call, from.x, from.y, function));
}

}  // namespace

void TexImage1D(Context& c, GLenum target, GLint level, GLint internal, GLsizei width, GLint border, GLenum format,
                GLenum type, const void* pixels) {
    ImageCall call = image_call(c, 1, target, level, format, type, pixels);
    call.internal_format = internal, call.border = border, call.width = width;
    define_image(c, call);
}

void TexImage2D(Context& c, GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLint border,
                GLenum format, GLenum type, const void* pixels) {
    ImageCall call = image_call(c, 2, target, level, format, type, pixels);
    call.internal_format = internal, call.border = border, call.width = width, call.height = height;
    define_image(c, call);
}

void TexImage3D(Context& c, GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLsizei depth,
                GLint border, GLenum format, GLenum type, const void* pixels) {
    ImageCall call = image_call(c, 3, target, level, format, type, pixels);
    call.internal_format = internal, call.border = border, call.width = width, call.height = height, call.depth = depth;
    define_image(c, call);
}

void TexSubImage1D(Context& c, GLenum target, GLint level, GLint x, GLsizei width, GLenum format, GLenum type,
                   const void* pixels) {
    ImageCall call = image_call(c, 1, target, level, format, type, pixels);
    call.x = x, call.width = width;
    define_sub_image(c, call);
}

void TexSubImage2D(Context& c, GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                   GLenum format, GLenum type, const void* pixels) {
    ImageCall call = image_call(c, 2, target, level, format, type, pixels);
    call.x = x, call.y = y, call.width = width, call.height = height;
    define_sub_image(c, call);
}

void TexSubImage3D(Context& c, GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
                   GLsizei depth, GLenum format, GLenum type, const void* pixels) {
    ImageCall call = image_call(c, 3, target, level, format, type, pixels);
    call.x = x, call.y = y, call.z = z, call.width = width, call.height = height, call.depth = depth;
    define_sub_image(c, call);
}

void CopyTexImage1D(Context& c, GLenum target, GLint level, GLenum internal, GLint x, GLint y, GLsizei width,
                    GLint border) {
    ImageCall call = image_call(c, 1, target, level, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    call.border = border, call.width = width;
    copy_image(c, call, internal, {x, y}, "glCopyTexImage1D");
}

void CopyTexImage2D(Context& c, GLenum target, GLint level, GLenum internal, GLint x, GLint y, GLsizei width,
                    GLsizei height, GLint border) {
    ImageCall call = image_call(c, 2, target, level, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    call.border = border, call.width = width, call.height = height;
    copy_image(c, call, internal, {x, y}, "glCopyTexImage2D");
}

void CopyTexSubImage1D(Context& c, GLenum target, GLint level, GLint to_x, GLint x, GLint y, GLsizei width) {
    ImageCall call = image_call(c, 1, target, level, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    call.x = to_x, call.width = width;
    copy_sub_image(c, call, {x, y}, "glCopyTexSubImage1D");
}

void CopyTexSubImage2D(Context& c, GLenum target, GLint level, GLint to_x, GLint to_y, GLint x, GLint y, GLsizei width,
                       GLsizei height) {
    ImageCall call = image_call(c, 2, target, level, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    call.x = to_x, call.y = to_y, call.width = width, call.height = height;
    copy_sub_image(c, call, {x, y}, "glCopyTexSubImage2D");
}

void CopyTexSubImage3D(Context& c, GLenum target, GLint level, GLint to_x, GLint to_y, GLint to_z, GLint x, GLint y,
                       GLsizei width, GLsizei height) {
    ImageCall call = image_call(c, 3, target, level, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    call.x = to_x, call.y = to_y, call.z = to_z, call.width = width, call.height = height;
    copy_sub_image(c, call, {x, y}, "glCopyTexSubImage3D");
}

}  // namespace wall::client::api
