// SPDX-License-Identifier: MIT
#include "common/codec/frame.h"

namespace wall::codec {
namespace {

std::string size_of(std::uint64_t width, std::uint64_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

std::string_view name_of(PixelLayout layout) {
    switch (layout) {
        case PixelLayout::bgra: return "bgra";
        case PixelLayout::rgba: return "rgba";
        case PixelLayout::yuy2: return "yuy2";
    }
    return "unknown";
}

Result<void> check(const StreamFormat& format) {
    const auto size = size_of(format.width, format.height);
    if (format.width < 1 || format.height < 1 || format.width > kMaxExtent || format.height > kMaxExtent)
        return fail("frames of " + size + " pixels; expected 1 to " + std::to_string(kMaxExtent) + " a side");
    if (std::uint64_t{format.width} * format.height > kMaxPixels)
        return fail("frames of " + size + " pixels; the limit is " + std::to_string(kMaxPixels) + " pixels");
    if (format.layout == PixelLayout::yuy2 && format.width % 2 != 0)
        return fail("yuy2 frames of " + size + " pixels; expected an even width");
    return {};
}

Result<void> check(const FrameView& frame, const StreamFormat& format) {
    if (frame.width != format.width || frame.height != format.height)
        return fail("frame of " + size_of(frame.width, frame.height) + " pixels in a stream of " +
                    size_of(format.width, format.height));
    if (frame.layout != format.layout)
        return fail("frame in " + std::string(name_of(frame.layout)) + " in a stream of " +
                    std::string(name_of(format.layout)));
    return {};
}

Picture::Picture(const StreamFormat& format)
    : format_(format),
      row_bytes_(std::size_t{format.width} * bytes_per_pixel(format.layout)),
      bytes_(row_bytes_ * format.height) {}

}  // namespace wall::codec
