// SPDX-License-Identifier: MIT
// A texture as the application defined it: the recovery log of one object. Every change has a stamp; a node that holds
// the texture as of an older stamp is sent what changed since, whole levels or rectangles (DESIGN, section 4).
// Guarded by the share group's mutex.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "client_lib/objects/buffer.h"
#include "client_lib/objects/object.h"
#include "client_lib/objects/texture_formats.h"
#include "common/glapi/content_hash.h"
#include "common/glapi/gl_types.h"
#include "common/glapi/texture_target.h"

namespace wall::client {

class DrawnTarget;

struct TexBox {
    std::int32_t x = 0, y = 0, z = 0, width = 0, height = 0, depth = 0;
    std::uint64_t stamp = 0;
};

/// Why a level has pixels.
enum class LevelContent : std::uint8_t {
    none,       ///< glTexImage without pixels
    stored,     ///< `pixels`
    generated,  ///< made from the base level by each node itself
    drawn,      ///< by the nodes; `pixels` has only what was changed since, in `changes`
};

struct TextureLevel {
    GLint internal_format = 0;                                  ///< as the application gave it; 0: not defined
    std::int32_t width = 0, height = 0, depth = 0, border = 0;  ///< with border
    GLenum format = 0, type = 0;  ///< of the call that defined it: the driver's choice of storage depends on them
    GLenum data_format = 0, data_type = 0;  ///< of `pixels`
    bool compressed = false;                ///< pixels as for glCompressedTexImage, format and type 0
    std::uint32_t samples = 0;              ///< of each texel, of a target that has them; there are no pixels then
    bool fixed_places = false;              ///< of the samples, the same in all texels
    LevelContent content = LevelContent::none;
    std::vector<std::byte> pixels;
    std::uint64_t stamp = 0;      ///< of the definition
    std::vector<TexBox> changes;  ///< since then, oldest first

    bool defined() const { return internal_format != 0; }
    void note_change(TexBox box);
    /// All nodes have drawn to it, each with all that was changed before.
    void note_drawn();
};

inline constexpr unsigned kTextureLevels = 15;  ///< 16384 texels a side

/// One glTexParameter value: as a node is told it.
struct TexParameters {
    std::array<float, 4> border_color{};  ///< the bits of whole numbers if border_whole
    bool border_whole = false;
    std::array<GLenum, 4> swizzle{GL_RED, GL_GREEN, GL_BLUE, GL_ALPHA};
    GLenum srgb_decode = GL_DECODE_EXT;
    float priority = 1, min_lod = -1000, max_lod = 1000, lod_bias = 0, max_anisotropy = 1;
    GLenum min_filter = GL_NEAREST_MIPMAP_LINEAR, mag_filter = GL_LINEAR;
    GLenum wrap_s = GL_REPEAT, wrap_t = GL_REPEAT, wrap_r = GL_REPEAT;
    GLint base_level = 0, max_level = 1000;
    GLenum compare_mode = GL_NONE, compare_func = GL_LEQUAL, depth_mode = GL_LUMINANCE;
    GLenum depth_stencil_mode = GL_DEPTH_COMPONENT;
    bool generate_mipmap = false;
    std::array<GLint, 4> crop_rectangle{};  ///< of GL_OES_draw_texture: texels; nodes are not told
};

struct Texture : Object {
    Texture(ClientName own_id, GLuint own_name, glapi::TextureTarget own_target);
    const glapi::TextureTargetInfo& info;  ///< of its target

    const Object* rests_on() const override { return view.origin.get(); }
    std::uint64_t latest() const override { return stamp; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;
    bool is_drawn() const override;
    void pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>& packed) const override;
    bool worth_asking() const override;
    void pack_question(wire::PackBuffer& buffer, RequestId request) const override;
    bool pack_shared(wire::PackBuffer& buffer) const override;

    std::uint64_t stamp = 0;  ///< of the latest change
    TexParameters parameters;
    /// Stamp of the latest change of each parameter that differs from its default or once did.
    std::vector<std::pair<GLenum, std::uint64_t>> parameter_stamps;
    std::vector<ContextId> bound_by;  ///< contexts that ever bound it
    bool global = false;  ///< the processes of the program mean the same by its name (GL_WALLGL_global_texture)
    std::uint64_t generated_stamp = 0;             ///< of the latest mipmap generation; 0: none
    GLint generated_base = 0, generated_last = 0;  ///< the level that they were made of, and the last that was allowed
    std::array<std::vector<TextureLevel>, glapi::kCubeFaces> faces;
    /// As of a stamp: see content_key().
    mutable std::pair<std::uint64_t, glapi::ContentKey> key_cache{};

    /// Of GL_TEXTURE_BUFFER: the part of a buffer that the texels are. bytes 0: as far as the buffer goes.
    struct BufferPart {
        std::shared_ptr<Buffer> buffer;  ///< null: none
        GLenum internal_format = GL_R8;
        std::uint32_t offset = 0, bytes = 0;
        std::uint32_t size() const;  ///< bytes of it that there are
    } part;

    std::uint32_t immutable_levels = 0;  ///< glTexStorage gave it so many, for good; 0: it did not

    /// Of storage for good, which part of it the texture is (OpenGL 4.5, 8.18); layers are a cube map's faces, too.
    struct View {
        /// Whose storage it is, which has an own one; null: its own. Its images hold texels only while they are read
        /// (objects/texture_view.h).
        std::shared_ptr<Texture> origin;
        std::uint32_t first_level = 0, levels = 0, first_layer = 0, layers = 0;
        std::uint64_t stamp = 0;  ///< of the definition
    } view;
    std::uint32_t views = 0;          ///< textures that it is the origin of
    std::uint64_t storage_stamp = 0;  ///< since when nodes keep its levels as one storage, for views; 0: they do not
    std::weak_ptr<DrawnTarget> drawn_by;  ///< that it was last drawn anew as an image of
    bool orphan = false;                  ///< its name is gone; it goes with the last framebuffer that has it

    bool is_default() const { return name == 0; }
    TextureLevel* find_level(unsigned face, GLint level);
    const TextureLevel* find_level(unsigned face, GLint level) const;
    /// Whether only the nodes have all of a level: it is drawn, or made of what was.
    bool only_on_nodes(const TextureLevel& level) const {
        return level.content == LevelContent::drawn || (level.content == LevelContent::generated && is_drawn());
    }
    /// An image was drawn to, wherever its texels are kept.
    void note_drawn(unsigned face, GLint level);
    /// Shaders have written to an image of it: to all layers of a level, or to one.
    void note_written(GLint level, bool layered, GLint layer);
    TextureLevel& level_at(unsigned face, GLint level);
    void parameter_changed(GLenum pname);
    /// The base level got new pixels and the parameter is set, or glGenerateMipmap.
    void mipmaps_generated();
};

/// Current value of a parameter as four numbers for the TexParameter command; a border colour of whole numbers: their
/// bits.
std::array<float, 4> parameter_value(const TexParameters& p, GLenum pname);
/// To the bit.
bool same_parameter(const TexParameters& a, const TexParameters& b, GLenum pname);

/// How the texels of a level travel between nodes, so that none of them changes; the level is not compressed.
PixelKind exact_pixels(const TextureLevel& level);

/// Calls `use(slice, first_row, rows)` for parts of a level as they are asked for, so that no answer is too large.
template <class Use>
void for_each_part(const TextureLevel& level, Use&& use) {
    for (std::int32_t slice = 0; slice < level.depth; ++slice)
        for_each_rows(level.width, level.height, [&](std::int32_t y, std::int32_t rows) { use(slice, y, rows); });
}

/// Images larger than this travel in several pieces.
inline constexpr std::size_t kLargestImageCommand = std::size_t{16} << 20;

/// The name of what pack_changes() would say to a node that has nothing, but for the texture's id. Of a global one: the
/// program's name stands for the pixels, and nobody looks at them (A6.2: the same name and parameters are the same
/// texture).
const glapi::ContentKey& content_key(const Texture& texture);
/// Of all pixels.
std::size_t content_bytes(const Texture& texture);

/// What a word means to a program: nothing if it is none for a texture target, or for one that programs do not have.
std::optional<glapi::TargetWord> target_word(GLenum word);
/// The target whose textures are bound by that word; null: none. Faces and proxies are no such words.
const glapi::TextureTargetInfo* target_of(GLenum word);
/// The target whose images that word names: a target's, a face's, a proxy's; null: none.
const glapi::TextureTargetInfo* image_target_of(GLenum word);
bool is_proxy(GLenum word);
/// 0 to 5 for a cube map's face, else 0.
unsigned face_of(GLenum word);

}  // namespace wall::client
