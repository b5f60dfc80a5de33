// SPDX-License-Identifier: MIT
// A renderbuffer as the application defined it (OpenGL 4.6, 9.2.4): an image that is drawn to and never sampled. Its
// content is the nodes' alone. Guarded by the share group's mutex.
#pragma once

#include <cstdint>
#include <functional>

#include "client_lib/objects/object.h"
#include "client_lib/objects/texture_formats.h"

namespace wall::client {

class Renderbuffer : public Object {
public:
    explicit Renderbuffer(GLuint own_name) : Object(next_object_id(), own_name) {}

    /// New memory. `samples`: 0, one a pixel.
    void define(std::uint32_t samples, GLenum internal_format, std::uint32_t width, std::uint32_t height);
    bool has_storage() const { return width_ != 0 && height_ != 0; }
    std::uint32_t samples() const { return samples_; }
    GLenum internal_format() const { return internal_format_; }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;
    /// Something was drawn to it.
    void note_drawn() { drawn_ = true; }
    /// Several samples a pixel cannot be read, so they stay where they are.
    bool is_drawn() const override { return drawn_ && samples_ == 0; }
    void pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>& packed) const override;

    bool orphan = false;  ///< its name is gone; it goes with the last framebuffer that has it

private:
    std::uint32_t samples_ = 0, width_ = 0, height_ = 0;
    GLenum internal_format_ = GL_RGBA;
    std::uint64_t stamp_ = 0;
    bool drawn_ = false;
};

/// Of an image with that internal format, as the driver stores it. Null: nothing can be drawn to such an image.
const TextureFormat* find_renderbuffer_format(GLenum internal_format);

}  // namespace wall::client
