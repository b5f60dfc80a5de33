// SPDX-License-Identifier: MIT
// Pictures as codecs take and give them: rows of packed 8-bit pixels. Values; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/wire/limits.h"

namespace wall::codec {

/// Bytes of a pixel in memory order. `yuy2` is Y0 U Y1 V for two pixels side by side (ITU-R BT.601 4:2:2), width even.
enum class PixelLayout : std::uint8_t { bgra, rgba, yuy2 };

constexpr std::size_t bytes_per_pixel(PixelLayout layout) { return layout == PixelLayout::yuy2 ? 2 : 4; }
std::string_view name_of(PixelLayout layout);

inline constexpr std::uint32_t kMaxExtent = wire::kMaxSurfaceExtent;  ///< pixels a side
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 26;   ///< pixels of a frame: 256 MiB of BGRA

/// What stays the same over all frames of a stream.
struct StreamFormat {
    std::uint32_t width = 0, height = 0;  ///< pixels
    PixelLayout layout = PixelLayout::bgra;
    bool alpha = false;  ///< false: alpha is not kept and decodes as 255

    bool operator==(const StreamFormat&) const = default;
};

/// Nothing, or which side or product is out of bounds.
Result<void> check(const StreamFormat& format);

/// Somebody else's pixels, top row first. They must stay while the view is used.
struct FrameView {
    const std::byte* pixels = nullptr;  ///< the top row
    std::uint32_t width = 0, height = 0;
    std::ptrdiff_t stride =
        0;  ///< bytes from a row to the one below; negative when the bottom row comes first in memory
    PixelLayout layout = PixelLayout::bgra;

    const std::byte* row(std::uint32_t y) const { return pixels + static_cast<std::ptrdiff_t>(y) * stride; }
    std::size_t row_bytes() const { return std::size_t{width} * bytes_per_pixel(layout); }
};

/// Nothing, or how the frame differs from what its stream was opened for.
Result<void> check(const FrameView& frame, const StreamFormat& format);

/// Owned pixels without padding between rows.
class Picture {
public:
    Picture() = default;
    /// `format` must have passed check(). All bytes zero.
    explicit Picture(const StreamFormat& format);

    std::byte* row(std::uint32_t y) { return bytes_.data() + y * row_bytes_; }
    std::ptrdiff_t stride() const { return static_cast<std::ptrdiff_t>(row_bytes_); }
    std::vector<std::byte>& bytes() { return bytes_; }
    FrameView view() const { return {bytes_.data(), format_.width, format_.height, stride(), format_.layout}; }

private:
    StreamFormat format_;
    std::size_t row_bytes_ = 0;
    std::vector<std::byte> bytes_;
};

}  // namespace wall::codec
