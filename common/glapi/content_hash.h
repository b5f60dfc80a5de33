// SPDX-License-Identifier: MIT
// What an object's content is called, so that a node can tell that it has it already (A6: global share).
// The name is the SHA-256 of the commands that define the object, without its id. A program that could make two
// contents of one name could put its pictures into other people's windows, so a fast checksum would not do. Any thread,
// one at a time.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>

#include "common/base/ids.h"
#include "common/glapi/gl_types.h"
#include "gen/glapi/wire.gen.h"

namespace wall::glapi {

using ContentKey = std::array<std::byte, 32>;

class ContentHash {
public:
    ContentHash();
    ~ContentHash();
    ContentHash(ContentHash&&) noexcept;
    ContentHash& operator=(ContentHash&&) noexcept;

    // ---- the stream's commands of these names (proto/gl/wire.toml), without the object ----
    void TexParameter(GLenum target, GLenum pname, float p0, float p1, float p2, float p3) {
        add(Op::TexParameter, {}, target, pname, p0, p1, p2, p3);
    }
    void TexBorderWhole(GLenum target, std::int32_t p0, std::int32_t p1, std::int32_t p2, std::int32_t p3) {
        add(Op::TexBorderWhole, {}, target, p0, p1, p2, p3);
    }
    void TexImage(GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width, std::int32_t height,
                  std::int32_t depth, std::int32_t border, GLenum format, GLenum type,
                  std::span<const std::byte> pixels) {
        add(Op::TexImage, pixels, target, level, internal_format, width, height, depth, border, format, type);
    }
    void TexSubImage(GLenum target, std::int32_t level, std::int32_t x, std::int32_t y, std::int32_t z,
                     std::int32_t width, std::int32_t height, std::int32_t depth, GLenum format, GLenum type,
                     std::span<const std::byte> pixels) {
        add(Op::TexSubImage, pixels, target, level, x, y, z, width, height, depth, format, type);
    }
    void TexCompressed(GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width,
                       std::int32_t height, std::int32_t depth, std::span<const std::byte> blocks) {
        add(Op::TexCompressed, blocks, target, level, internal_format, width, height, depth);
    }
    void TexImageSamples(GLenum target, std::uint32_t samples, GLenum internal_format, std::int32_t width,
                         std::int32_t height, std::int32_t depth, std::uint32_t fixed) {
        add(Op::TexImageSamples, {}, target, samples, internal_format, width, height, depth, fixed);
    }
    void TexMipmaps(GLenum target, std::int32_t base, std::int32_t last) {
        add(Op::TexMipmaps, {}, target, base, last);
    }
    void ShaderCompile(GLenum type, std::span<const std::byte> source) { add(Op::ShaderCompile, source, type); }
    void ProgramLink(std::span<const std::byte> definition) { add(Op::ProgramLink, definition); }
    /// A name that a program gave, instead of pixels: GL_WALLGL_global_texture.
    void OwnName(std::uint32_t name) { add(Op::ShareTexture, {}, name); }
    /// A name of content that is known only in one session.
    void InSession(SessionId session, const ContentKey& key) { add(Op::ShareTexture, key, session.value); }
    void RunDefine(std::uint32_t commands, std::uint32_t operand_bytes, std::span<const std::byte> content) {
        add(Op::RunDefine, content, commands, operand_bytes);
    }

    /// The name of everything so far. Nothing may be added after that.
    ContentKey finish();

private:
    template <class... Words>
    void add(Op op, std::span<const std::byte> bytes, Words... words) {
        const std::array head = {static_cast<std::uint32_t>(op), std::bit_cast<std::uint32_t>(words)...,
                                 static_cast<std::uint32_t>(bytes.size())};
        add(std::as_bytes(std::span(head)));
        add(bytes);
    }
    void add(std::span<const std::byte> bytes);

    struct Digest;
    std::unique_ptr<Digest> digest_;
};

}  // namespace wall::glapi
