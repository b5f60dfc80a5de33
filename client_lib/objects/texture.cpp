// SPDX-License-Identifier: MIT
#include "client_lib/objects/texture.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "client_lib/objects/texture_formats.h"
#include "common/glapi/image.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

/// Rectangles remembered one by one; older ones are merged.
constexpr std::size_t kMaxChanges = 16;

TexBox united(const TexBox& a, const TexBox& b) {
    TexBox out;
    out.x = std::min(a.x, b.x);
    out.y = std::min(a.y, b.y);
    out.z = std::min(a.z, b.z);
    out.width = std::max(a.x + a.width, b.x + b.width) - out.x;
    out.height = std::max(a.y + a.height, b.y + b.height) - out.y;
    out.depth = std::max(a.z + a.depth, b.z + b.depth) - out.z;
    out.stamp = std::max(a.stamp, b.stamp);
    return out;
}

/// The tight bytes of a box of a level.
std::vector<std::byte> cut(const TextureLevel& level, const TexBox& box) {
    const auto layout = glapi::pixel_layout(level.data_format, level.data_type);
    if (!layout) return {};
    const std::size_t row = glapi::row_bytes(*layout, level.width), bytes = glapi::row_bytes(*layout, box.width);
    std::vector<std::byte> out(bytes * static_cast<std::size_t>(box.height) * static_cast<std::size_t>(box.depth));
    std::byte* to = out.data();
    for (std::int32_t z = 0; z < box.depth; ++z)
        for (std::int32_t y = 0; y < box.height; ++y, to += bytes) {
            const auto line = static_cast<std::size_t>(box.z + z) * static_cast<std::size_t>(level.height) +
                              static_cast<std::size_t>(box.y + y);
            std::memcpy(to, level.pixels.data() + line * row + static_cast<std::size_t>(box.x) * layout->pixel_bytes,
                        bytes);
        }
    return out;
}

/// The commands that bring a follower of one texture up to date, to a sink that has members of their names without the
/// object.
template <class Sink>
class TextureDiff {
public:
    TextureDiff(const Texture& texture, Sink& sink) : texture_(texture), sink_(sink) {}

    void run(std::uint64_t known);
    void parameters(std::uint64_t known) {
        for (const auto& [pname, stamp] : texture_.parameter_stamps)
            if (stamp > known) current_parameter(pname);
    }

private:
    void current_parameter(GLenum pname) {
        any_ = true;
        auto v = parameter_value(texture_.parameters, pname);
        if (pname == GL_TEXTURE_MAX_LEVEL && texture_.immutable_levels != 0 && !texture_.view.origin)
            v[0] = static_cast<float>(last_level());
        if (pname == GL_TEXTURE_BORDER_COLOR && texture_.parameters.border_whole) {
            const auto w = std::bit_cast<std::array<std::int32_t, 4>>(v);
            return sink_.TexBorderWhole(texture_.info.target, w[0], w[1], w[2], w[3]);
        }
        sink_.TexParameter(texture_.info.target, pname, v[0], v[1], v[2], v[3]);
    }
    /// Of storage for good: what sampling makes of the parameters (OpenGL 4.2, 3.9.13).
    GLint last_level() const {
        const TexParameters& p = texture_.parameters;
        const auto last = static_cast<GLint>(texture_.immutable_levels) - 1;
        return std::clamp(p.max_level, std::min(p.base_level, last), last);
    }
    void mipmaps();
    /// What changed of one level since `known`.
    void level(unsigned face, GLint number, std::uint64_t known);
    void define(unsigned face, GLint number, const TextureLevel& level);
    void box(unsigned face, GLint number, const TextureLevel& level, const TexBox& box);
    void piece(unsigned face, GLint number, const TextureLevel& level, const TexBox& box);

    const Texture& texture_;
    Sink& sink_;
    bool any_ = false;
};

template <class Sink>
void TextureDiff<Sink>::run(std::uint64_t known) {
    parameters(known);
    const GLint base = texture_.generated_base;
    for (unsigned face = 0; face < glapi::face_count(texture_.info); ++face) level(face, base, known);
    if (texture_.generated_stamp > known) mipmaps();
    for (unsigned face = 0; face < glapi::face_count(texture_.info); ++face)
        for (GLint number = 0; number < static_cast<GLint>(texture_.faces[face].size()); ++number)
            if (number != base) level(face, number, known);
    // A name that a state element carries must exist on the node.
    if (known == 0 && !any_) current_parameter(texture_.info.samples ? GL_TEXTURE_MAX_LEVEL : GL_TEXTURE_MAG_FILTER);
}

// Nodes never see GL_GENERATE_MIPMAP: whether the application had it set when some level came is history that a late
// node cannot replay.
template <class Sink>
void TextureDiff<Sink>::mipmaps() {
    any_ = true;
    sink_.TexMipmaps(texture_.info.target, texture_.generated_base, texture_.generated_last);
}

template <class Sink>
void TextureDiff<Sink>::level(unsigned face, GLint number, std::uint64_t known) {
    const auto& levels = texture_.faces[face];
    if (static_cast<std::size_t>(number) >= levels.size()) return;
    const TextureLevel& level = levels[static_cast<std::size_t>(number)];
    if (!level.defined() || level.content == LevelContent::generated) return;
    if (level.stamp > known) define(face, number, level);
    if (level.stamp > known && level.content != LevelContent::drawn) return;
    for (const TexBox& change : level.changes)
        if (change.stamp > known) box(face, number, level, change);
}

template <class Sink>
void TextureDiff<Sink>::define(unsigned face, GLint number, const TextureLevel& level) {
    any_ = true;
    const auto internal = static_cast<GLenum>(level.internal_format);
    const GLenum target = glapi::image_target(texture_.info, face);
    if (level.compressed) {
        return sink_.TexCompressed(target, number, internal, level.width, level.height, level.depth,
                                   std::span<const std::byte>(level.pixels));
    }
    if (texture_.storage_stamp != 0) {  // which is there
        if (level.content == LevelContent::stored)
            box(face, number, level, {0, 0, 0, level.width, level.height, level.depth, 0});
        return;
    }
    if (level.samples != 0)
        return sink_.TexImageSamples(target, level.samples, internal, level.width, level.height, level.depth,
                                     level.fixed_places ? 1u : 0u);
    const bool stored = level.content == LevelContent::stored;
    const bool at_once = stored && level.format == level.data_format && level.type == level.data_type &&
                         level.pixels.size() <= kLargestImageCommand;
    sink_.TexImage(target, number, internal, level.width, level.height, level.depth, 0, level.format, level.type,
                   at_once ? std::span<const std::byte>(level.pixels) : std::span<const std::byte>());
    if (stored && !at_once) box(face, number, level, {0, 0, 0, level.width, level.height, level.depth, 0});
}

// A large box goes slice by slice, in as many rows as fit.
template <class Sink>
void TextureDiff<Sink>::box(unsigned face, GLint number, const TextureLevel& level, const TexBox& box) {
    const auto layout = glapi::pixel_layout(level.data_format, level.data_type);
    if (!layout) return;
    const std::size_t row = std::max<std::size_t>(glapi::row_bytes(*layout, box.width), 1);
    const std::size_t all = row * static_cast<std::size_t>(box.height) * static_cast<std::size_t>(box.depth);
    if (all <= kLargestImageCommand) return piece(face, number, level, box);
    const auto rows = static_cast<std::int32_t>(std::max<std::size_t>(kLargestImageCommand / row, 1));
    for (std::int32_t z = 0; z < box.depth; ++z)
        for (std::int32_t y = 0; y < box.height; y += rows)
            piece(face, number, level, {box.x, box.y + y, box.z + z, box.width, std::min(rows, box.height - y), 1, 0});
}

template <class Sink>
void TextureDiff<Sink>::piece(unsigned face, GLint number, const TextureLevel& level, const TexBox& box) {
    const bool whole = box.width == level.width && box.height == level.height && box.depth == level.depth;
    const auto part = whole ? std::vector<std::byte>() : cut(level, box);
    any_ = true;
    sink_.TexSubImage(glapi::image_target(texture_.info, face), number, box.x, box.y, box.z, box.width, box.height,
                      box.depth, level.data_format, level.data_type,
                      whole ? std::span<const std::byte>(level.pixels) : std::span<const std::byte>(part));
}

/// Packs them for a node.
struct TexturePacker {
    ClientName id;
    wire::PackBuffer& buffer;
    const std::function<void()>& packed;

    template <class... Operands>
    void TexParameter(Operands... operands) {
        glapi::pack::TexParameter(buffer, id, operands...);
        packed();
    }
    template <class... Operands>
    void TexBorderWhole(Operands... operands) {
        glapi::pack::TexBorderWhole(buffer, id, operands...);
        packed();
    }
    template <class... Operands>
    void TexImage(Operands... operands) {
        glapi::pack::TexImage(buffer, id, operands...);
        packed();
    }
    template <class... Operands>
    void TexImageSamples(Operands... operands) {
        glapi::pack::TexImageSamples(buffer, id, operands...);
        packed();
    }
    template <class... Operands>
    void TexSubImage(Operands... operands) {
        glapi::pack::TexSubImage(buffer, id, operands...);
        packed();
    }
    template <class... Operands>
    void TexCompressed(Operands... operands) {
        glapi::pack::TexCompressed(buffer, id, operands...);
        packed();
    }
    void TexMipmaps(GLenum target, std::int32_t base, std::int32_t last) {
        glapi::pack::TexMipmaps(buffer, id, target, base, last);
        packed();
    }
};

/// Leaves out the pixels.
struct NameAndShape {
    glapi::ContentHash& hash;
    void TexParameter(GLenum target, GLenum pname, float p0, float p1, float p2, float p3) {
        hash.TexParameter(target, pname, p0, p1, p2, p3);
    }
    void TexBorderWhole(GLenum target, std::int32_t p0, std::int32_t p1, std::int32_t p2, std::int32_t p3) {
        hash.TexBorderWhole(target, p0, p1, p2, p3);
    }
    void TexImage(GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width, std::int32_t height,
                  std::int32_t depth, std::int32_t border, GLenum format, GLenum type, std::span<const std::byte>) {
        hash.TexImage(target, level, internal_format, width, height, depth, border, format, type, {});
    }
    void TexImageSamples(GLenum target, std::uint32_t samples, GLenum internal_format, std::int32_t width,
                         std::int32_t height, std::int32_t depth, std::uint32_t fixed) {
        hash.TexImageSamples(target, samples, internal_format, width, height, depth, fixed);
    }
    template <class... Operands>
    void TexSubImage(Operands...) {}
    void TexCompressed(GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width,
                       std::int32_t height, std::int32_t depth, std::span<const std::byte>) {
        hash.TexCompressed(target, level, internal_format, width, height, depth, {});
    }
    void TexMipmaps(GLenum target, std::int32_t base, std::int32_t last) { hash.TexMipmaps(target, base, last); }
};

}  // namespace

Texture::Texture(ClientName own_id, GLuint own_name, glapi::TextureTarget own_target)
    : Object(own_id, own_name), info(glapi::info_of(own_target)), stamp(next_stamp()) {
    if (!info.mipmaps) parameters.min_filter = GL_LINEAR;
    if (!info.repeats) parameters.wrap_s = parameters.wrap_t = parameters.wrap_r = GL_CLAMP_TO_EDGE;
}

void TextureLevel::note_change(TexBox box) {
    const auto covered = [&](const TexBox& old) {
        const TexBox u = united(old, box);
        return u.x == box.x && u.y == box.y && u.z == box.z && u.width == box.width && u.height == box.height &&
               u.depth == box.depth;
    };
    changes.erase(std::remove_if(changes.begin(), changes.end(), covered), changes.end());
    changes.push_back(box);
    if (changes.size() <= kMaxChanges || content == LevelContent::drawn) return;
    changes[1] = united(changes[0], changes[1]);
    changes.erase(changes.begin());
}

void TextureLevel::note_drawn() {
    if (content == LevelContent::drawn && changes.empty()) return;
    content = LevelContent::drawn;
    pixels = {};
    changes.clear();
}

void Texture::note_written(GLint level, bool layered, GLint layer) {
    if (part.buffer) part.buffer->note_drawn();
    for (unsigned face = 0; face < glapi::face_count(info); ++face) {
        TextureLevel* const image = find_level(face, level);
        const bool meant = layered || glapi::face_count(info) == 1 || static_cast<GLint>(face) == layer;
        if (image != nullptr && meant) note_drawn(face, level);
    }
}

// Of an origin whose layers are faces, all that the view has count: nodes hold each of them.
void Texture::note_drawn(unsigned face, GLint level) {
    if (!view.origin) {
        if (TextureLevel* const image = find_level(face, level)) image->note_drawn();
        return;
    }
    const GLint kept = level + static_cast<GLint>(view.first_level);
    const bool faced = view.origin->info.first_face != 0;
    const std::uint32_t first = info.first_face != 0 ? view.first_layer + face : view.first_layer,
                        count = info.first_face != 0 ? 1 : view.layers;
    for (std::uint32_t layer = first; layer < (faced ? first + count : first + 1); ++layer)
        view.origin->note_drawn(faced ? layer : 0, kept);
}

const TextureLevel* Texture::find_level(unsigned face, GLint level) const {
    return const_cast<Texture*>(this)->find_level(face, level);
}

TextureLevel* Texture::find_level(unsigned face, GLint level) {
    auto& levels = faces[face];
    if (level < 0 || static_cast<std::size_t>(level) >= levels.size() ||
        !levels[static_cast<std::size_t>(level)].defined())
        return nullptr;
    return &levels[static_cast<std::size_t>(level)];
}

TextureLevel& Texture::level_at(unsigned face, GLint level) {
    auto& levels = faces[face];
    if (levels.size() <= static_cast<std::size_t>(level)) levels.resize(static_cast<std::size_t>(level) + 1);
    return levels[static_cast<std::size_t>(level)];
}

void Texture::parameter_changed(GLenum pname) {
    stamp = next_stamp();
    for (auto& [known, when] : parameter_stamps)
        if (known == pname) {
            when = stamp;
            return;
        }
    parameter_stamps.emplace_back(pname, stamp);
}

void Texture::mipmaps_generated() {
    stamp = generated_stamp = next_stamp();
    const GLint base = generated_base = parameters.base_level;
    generated_last = parameters.max_level;
    if (immutable_levels != 0) generated_last = std::min(generated_last, static_cast<GLint>(immutable_levels) - 1);
    const unsigned halved = glapi::spatial_dimensions_of(info);
    for (unsigned face = 0; face < glapi::face_count(info); ++face) {
        const TextureLevel* from = find_level(face, base);
        if (!from) continue;
        TextureLevel next;
        next.internal_format = from->internal_format;
        next.format = from->format;
        next.type = from->type;
        next.content = LevelContent::generated;
        next.stamp = stamp;
        std::int32_t width = from->width, height = from->height, depth = from->depth;
        for (GLint level = base + 1; level <= generated_last && level < static_cast<GLint>(kTextureLevels); ++level) {
            if (width == 1 && (halved < 2 || height == 1) && (halved < 3 || depth == 1)) break;
            next.width = width = std::max(1, width / 2);
            next.height = height = halved < 2 ? height : std::max(1, height / 2);
            next.depth = depth = halved < 3 ? depth : std::max(1, depth / 2);
            level_at(face, level) = next;
        }
    }
}

std::array<float, 4> parameter_value(const TexParameters& p, GLenum pname) {
    const auto one = [](auto value) { return std::array<float, 4>{static_cast<float>(value), 0, 0, 0}; };
    switch (pname) {
        case GL_TEXTURE_BORDER_COLOR: return p.border_color;
        case GL_TEXTURE_MIN_FILTER: return one(p.min_filter);
        case GL_TEXTURE_MAG_FILTER: return one(p.mag_filter);
        case GL_TEXTURE_WRAP_S: return one(p.wrap_s);
        case GL_TEXTURE_WRAP_T: return one(p.wrap_t);
        case GL_TEXTURE_WRAP_R: return one(p.wrap_r);
        case GL_TEXTURE_PRIORITY: return one(p.priority);
        case GL_TEXTURE_MIN_LOD: return one(p.min_lod);
        case GL_TEXTURE_MAX_LOD: return one(p.max_lod);
        case GL_TEXTURE_LOD_BIAS: return one(p.lod_bias);
        case GL_TEXTURE_BASE_LEVEL: return one(p.base_level);
        case GL_TEXTURE_MAX_LEVEL: return one(p.max_level);
        case GL_TEXTURE_MAX_ANISOTROPY_EXT: return one(p.max_anisotropy);
        case GL_TEXTURE_COMPARE_MODE: return one(p.compare_mode);
        case GL_TEXTURE_COMPARE_FUNC: return one(p.compare_func);
        case GL_DEPTH_TEXTURE_MODE: return one(p.depth_mode);
        case GL_DEPTH_STENCIL_TEXTURE_MODE: return one(p.depth_stencil_mode);
        case GL_TEXTURE_SWIZZLE_R:
        case GL_TEXTURE_SWIZZLE_G:
        case GL_TEXTURE_SWIZZLE_B:
        case GL_TEXTURE_SWIZZLE_A: return one(p.swizzle[pname - GL_TEXTURE_SWIZZLE_R]);
        case GL_TEXTURE_SWIZZLE_RGBA: {
            std::array<float, 4> all;
            std::ranges::transform(p.swizzle, all.begin(), [](GLenum word) { return static_cast<float>(word); });
            return all;
        }
        case GL_TEXTURE_SRGB_DECODE_EXT: return one(p.srgb_decode);
        case GL_TEXTURE_CROP_RECT_OES: {
            std::array<float, 4> all;
            std::ranges::transform(p.crop_rectangle, all.begin(), [](GLint side) { return static_cast<float>(side); });
            return all;
        }
        default: return one(p.generate_mipmap ? 1 : 0);
    }
}

bool same_parameter(const TexParameters& a, const TexParameters& b, GLenum pname) {
    using Bits = std::array<std::uint32_t, 4>;
    return std::bit_cast<Bits>(parameter_value(a, pname)) == std::bit_cast<Bits>(parameter_value(b, pname)) &&
           (pname != GL_TEXTURE_BORDER_COLOR || a.border_whole == b.border_whole);
}

namespace {

void pack_storage(const Texture& texture, wire::PackBuffer& buffer) {
    const TextureLevel& first = texture.faces[0][0];
    glapi::pack::TexStorage(buffer, texture.id, texture.info.target, texture.immutable_levels,
                            static_cast<GLenum>(first.internal_format), first.width, first.height, first.depth,
                            first.samples, first.fixed_places ? 1u : 0u);
}

}  // namespace

std::uint32_t Texture::BufferPart::size() const {
    if (!buffer || offset >= buffer->size()) return 0;
    const auto rest = static_cast<std::uint32_t>(buffer->size() - offset);
    return bytes != 0 ? std::min(bytes, rest) : rest;
}

void Texture::pack_changes(std::uint64_t known, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    if (info.id == glapi::TextureTarget::buffer) {  // it has no parameters
        glapi::pack::TexBuffer(buffer, id, part.internal_format, part.buffer ? part.buffer->id : ClientName(),
                               part.offset, part.bytes);
        return packed();
    }
    TexturePacker packer{id, buffer, packed};
    if (view.origin) {
        if (view.stamp > known)
            glapi::pack::TexView(buffer, id, view.origin->id, info.target,
                                 static_cast<GLenum>(faces[0][0].internal_format), view.first_level, view.levels,
                                 view.first_layer, view.layers);
        return TextureDiff(*this, packer).parameters(known);
    }
    if (storage_stamp > known) pack_storage(*this, buffer);
    TextureDiff(*this, packer).run(known);
}

// What a view holds while it is read is the origin's.
bool Texture::is_drawn() const {
    if (view.origin) return false;
    return std::ranges::any_of(faces, [](const auto& face) {
        return std::ranges::any_of(face, [](const auto& l) { return l.content == LevelContent::drawn; });
    });
}

// All levels that the client does not have, made or drawn: the mipmaps may be of an older picture than the base.
void Texture::pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    for (unsigned face = 0; face < glapi::face_count(info); ++face)
        for (GLint number = 0; number < static_cast<GLint>(faces[face].size()); ++number) {
            const TextureLevel& level = faces[face][static_cast<std::size_t>(number)];
            if (!level.defined() || !only_on_nodes(level) || level.samples != 0) continue;  // samples cannot be read
            const GLenum target = glapi::image_target(info, face);
            const auto [format, type] = exact_pixels(level);
            for_each_part(level, [&](std::int32_t slice, std::int32_t first, std::int32_t rows) {
                const auto pixels = ask(
                    [&](wire::PackBuffer& question, RequestId request) {
                        glapi::pack::TexRead(question, request, id, target, number, slice, first, rows, format, type);
                    },
                    {first, rows, level.width});
                if (!pixels || pixels->empty()) return;
                glapi::pack::TexSubImage(buffer, id, target, number, 0, first, slice, level.width, rows, 1, format,
                                         type, *pixels);
                packed();
            });
        }
}

PixelKind exact_pixels(const TextureLevel& level) {
    const TextureFormat* format = find_texture_format(level.internal_format);
    return format ? exact_pixels(*format, stored_bits(*format, level.format, level.type))
                  : PixelKind{GL_RGBA, GL_UNSIGNED_BYTE};
}

// A node's content of one name is one texture; what views share is not given to others.
bool Texture::worth_asking() const {
    if (view.origin || storage_stamp != 0) return false;
    return !is_drawn() && (global || content_bytes(*this) >= kLeastShared);
}

void Texture::pack_question(wire::PackBuffer& buffer, RequestId request) const {
    glapi::pack::ShareTexture(buffer, request, id, info.target, global ? 1 : 0, content_key(*this));
}

bool Texture::pack_shared(wire::PackBuffer& buffer) const {
    glapi::pack::TexShared(buffer, id);
    return true;
}

const glapi::ContentKey& content_key(const Texture& texture) {
    auto& [stamp, key] = texture.key_cache;
    if (stamp == texture.stamp) return key;
    glapi::ContentHash hash;
    if (texture.global) {
        NameAndShape named{hash};
        hash.OwnName(texture.name);
        TextureDiff(texture, named).run(0);
    } else {
        TextureDiff(texture, hash).run(0);
    }
    key = hash.finish();
    stamp = texture.stamp;
    return key;
}

std::size_t content_bytes(const Texture& texture) {
    std::size_t bytes = 0;
    for (const auto& face : texture.faces)
        for (const auto& level : face) bytes += level.pixels.size();
    return bytes;
}

std::optional<glapi::TargetWord> target_word(GLenum word) { return glapi::find_target_word(word); }

const glapi::TextureTargetInfo* target_of(GLenum word) {
    const auto found = target_word(word);
    return found && found->is_object() ? found->info : nullptr;
}

const glapi::TextureTargetInfo* image_target_of(GLenum word) {
    const auto found = target_word(word);
    return found && found->has_images() ? found->info : nullptr;
}

bool is_proxy(GLenum word) {
    const auto found = target_word(word);
    return found && found->is_proxy();
}

unsigned face_of(GLenum word) {
    const auto found = target_word(word);
    return found ? found->face : 0;
}

}  // namespace wall::client
