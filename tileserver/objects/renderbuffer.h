// SPDX-License-Identifier: MIT
// A renderbuffer of a session: an image that framebuffers draw to and nothing samples. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tileserver/driver/driver.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class Renderbuffer final : public ObjectOf<ObjectKind::renderbuffer> {
public:
    Renderbuffer(ObjectAccount& account, Driver& driver);
    ~Renderbuffer() override;

    GLuint name() const { return name_; }  ///< the driver's; the same for life but while it is enlarged
    std::int32_t width() const { return width_; }
    std::int32_t height() const { return height_; }
    /// Whether the session may have one of that many samples.
    bool affords_samples(std::uint64_t samples) const { return affords(kSampleBytes * samples, bytes()); }
    /// New memory, all 0. `samples`: 0, one a pixel. False: more than a session may have.
    [[nodiscard]] bool define(std::uint32_t samples, GLenum internal_format, std::int32_t width, std::int32_t height);

    /// It has another image of that size from now on, with anything in it, until it is restored. False: one of several
    /// samples a pixel, or more memory than a session may have.
    [[nodiscard]] bool enlarge(std::int32_t width, std::int32_t height);
    /// It is as it was before.
    void restore();

    /// Whether pixels of them can be read and written: there are such rows, of one sample a pixel.
    bool has_rows(std::int32_t first, std::int32_t rows) const {
        return samples_ == 0 && first >= 0 && rows >= 1 && rows <= height_ && first <= height_ - rows && width_ > 0;
    }
    /// Tight rows; `to` is as large as they are. What the driver cannot give stays as it is.
    void read(std::int32_t first, std::int32_t rows, GLenum format, GLenum type, std::span<std::byte> to);
    void write(std::int32_t first, std::int32_t rows, GLenum format, GLenum type, std::span<const std::byte> from);

private:
    static constexpr std::uint64_t kSampleBytes = 4;  // by estimate
    void clear();
    std::uint64_t own_bytes() const;
    /// What it is attached as.
    GLenum point() const;

    Driver& driver_;
    const Gl& gl_;
    GLuint name_ = 0;
    GLuint kept_ = 0;  // while it is enlarged: as it was before
    std::uint64_t larger_bytes_ = 0;
    GLenum internal_format_ = GL_NONE;
    std::uint32_t samples_ = 0;
    std::int32_t width_ = 0, height_ = 0;
};

}  // namespace wall::tileserver
