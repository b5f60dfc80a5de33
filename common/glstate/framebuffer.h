// SPDX-License-Identifier: MIT
// A framebuffer object as it travels (wire.toml, Framebuffer): which images it draws to and reads from (OpenGL 4.6,
// section 9.2). What travels is the draw buffers, the read buffer, what it is without attachments, the number of
// attachments, and five words for each. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/ids.h"
#include "common/glapi/gl_types.h"

namespace wall::glstate {

/// Of one framebuffer; as many fragment colours can be drawn at once.
inline constexpr unsigned kColorAttachments = 8;
/// Colours, depth, stencil.
inline constexpr unsigned kAttachmentPoints = kColorAttachments + 2;

/// The place of an attachment point among them all: the colours, then depth, then stencil; nothing: it is none, or one
/// that means two.
std::optional<unsigned> attachment_place(GLenum point);
/// The point of a place below kAttachmentPoints.
GLenum attachment_point(unsigned place);

inline constexpr std::int32_t kAllLayers = -1;  ///< all layers of a texture, or all faces

/// One image.
struct FramebufferAttachment {
    GLenum point = GL_NONE;
    ClientName object;        ///< a renderbuffer's or a texture's
    GLenum target = GL_NONE;  ///< GL_RENDERBUFFER, or the image target of the texture: a cube map's is that of a face
    std::int32_t level = 0;
    std::int32_t layer = 0;  ///< of an array's image, slice of a 3D one; or kAllLayers
    bool operator==(const FramebufferAttachment&) const = default;
};
static_assert(sizeof(FramebufferAttachment) == 5 * sizeof(std::uint32_t));

/// What it is while nothing is attached (OpenGL 4.3, 9.2.1); a width or height of 0: nothing.
struct FramebufferDefaults {
    std::uint32_t width = 0, height = 0, layers = 0, samples = 0;
    std::uint32_t fixed_places = 0;  ///< of the samples: 1, the same in all pixels
    bool operator==(const FramebufferDefaults&) const = default;
};
static_assert(sizeof(FramebufferDefaults) == 5 * sizeof(std::uint32_t));
inline constexpr std::uint32_t kMostDefaultSize = 1 << 14, kMostDefaultLayers = 1 << 11, kMostDefaultSamples = 32;

struct FramebufferDefinition {
    std::array<GLenum, kColorAttachments> draw_buffers{GL_COLOR_ATTACHMENT0};  ///< by fragment colour
    GLenum read_buffer = GL_COLOR_ATTACHMENT0;
    FramebufferDefaults defaults;
    std::vector<FramebufferAttachment> attachments;  ///< at most one for each point
    bool operator==(const FramebufferDefinition&) const = default;
};

std::vector<std::byte> encode(const FramebufferDefinition& definition);
/// Nothing if a definition does not look so, or says what no OpenGL command can: then the driver never sees it.
std::optional<FramebufferDefinition> decode_framebuffer(std::span<const std::byte> bytes);

}  // namespace wall::glstate
