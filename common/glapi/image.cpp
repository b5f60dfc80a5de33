// SPDX-License-Identifier: MIT
#include "common/glapi/image.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace wall::glapi {
namespace {

constexpr std::uint64_t kMaxImageBytes = std::uint64_t{1} << 31;

struct FormatRow {
    GLenum format;
    unsigned components;
    bool integer;
};

constexpr std::array kFormats = {
    FormatRow{GL_COLOR_INDEX, 1, false},
    FormatRow{GL_STENCIL_INDEX, 1, false},
    FormatRow{GL_DEPTH_COMPONENT, 1, false},
    FormatRow{GL_DEPTH_STENCIL, 2, false},
    FormatRow{GL_RED, 1, false},
    FormatRow{GL_GREEN, 1, false},
    FormatRow{GL_BLUE, 1, false},
    FormatRow{GL_ALPHA, 1, false},
    FormatRow{GL_LUMINANCE, 1, false},
    FormatRow{GL_LUMINANCE_ALPHA, 2, false},
    FormatRow{GL_INTENSITY, 1, false},
    FormatRow{GL_RG, 2, false},
    FormatRow{GL_RGB, 3, false},
    FormatRow{GL_BGR, 3, false},
    FormatRow{GL_RGBA, 4, false},
    FormatRow{GL_BGRA, 4, false},
    FormatRow{GL_ABGR_EXT, 4, false},
    FormatRow{GL_RED_INTEGER, 1, true},
    FormatRow{GL_GREEN_INTEGER, 1, true},
    FormatRow{GL_BLUE_INTEGER, 1, true},
    FormatRow{GL_ALPHA_INTEGER, 1, true},
    FormatRow{GL_RG_INTEGER, 2, true},
    FormatRow{GL_RGB_INTEGER, 3, true},
    FormatRow{GL_BGR_INTEGER, 3, true},
    FormatRow{GL_RGBA_INTEGER, 4, true},
    FormatRow{GL_BGRA_INTEGER, 4, true},
    FormatRow{GL_LUMINANCE_INTEGER_EXT, 1, true},
    FormatRow{GL_LUMINANCE_ALPHA_INTEGER_EXT, 2, true},
};

/// What a packed type goes with.
enum class Goes : std::uint8_t { rgb, rgba, depth_stencil, rgb_float };

struct TypeRow {
    GLenum type;
    unsigned element_bytes;
    unsigned packed_bytes;  ///< of a whole pixel; 0: one element a component
    Goes goes = Goes::rgb;
    bool integers = true;  ///< also with *_INTEGER formats
};

constexpr std::array kTypes = {
    TypeRow{GL_BYTE, 1, 0},
    TypeRow{GL_UNSIGNED_BYTE, 1, 0},
    TypeRow{GL_SHORT, 2, 0},
    TypeRow{GL_UNSIGNED_SHORT, 2, 0},
    TypeRow{GL_INT, 4, 0},
    TypeRow{GL_UNSIGNED_INT, 4, 0},
    TypeRow{GL_FLOAT, 4, 0, Goes::rgb, false},
    TypeRow{GL_HALF_FLOAT, 2, 0, Goes::rgb, false},
    TypeRow{GL_UNSIGNED_BYTE_3_3_2, 1, 1, Goes::rgb},
    TypeRow{GL_UNSIGNED_BYTE_2_3_3_REV, 1, 1, Goes::rgb},
    TypeRow{GL_UNSIGNED_SHORT_5_6_5, 2, 2, Goes::rgb},
    TypeRow{GL_UNSIGNED_SHORT_5_6_5_REV, 2, 2, Goes::rgb},
    TypeRow{GL_UNSIGNED_SHORT_4_4_4_4, 2, 2, Goes::rgba},
    TypeRow{GL_UNSIGNED_SHORT_4_4_4_4_REV, 2, 2, Goes::rgba},
    TypeRow{GL_UNSIGNED_SHORT_5_5_5_1, 2, 2, Goes::rgba},
    TypeRow{GL_UNSIGNED_SHORT_1_5_5_5_REV, 2, 2, Goes::rgba},
    TypeRow{GL_UNSIGNED_INT_8_8_8_8, 4, 4, Goes::rgba},
    TypeRow{GL_UNSIGNED_INT_8_8_8_8_REV, 4, 4, Goes::rgba},
    TypeRow{GL_UNSIGNED_INT_10_10_10_2, 4, 4, Goes::rgba},
    TypeRow{GL_UNSIGNED_INT_2_10_10_10_REV, 4, 4, Goes::rgba},
    TypeRow{GL_UNSIGNED_INT_24_8, 4, 4, Goes::depth_stencil},
    TypeRow{GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 4, 8, Goes::depth_stencil},
    TypeRow{GL_UNSIGNED_INT_10F_11F_11F_REV, 4, 4, Goes::rgb_float},
    TypeRow{GL_UNSIGNED_INT_5_9_9_9_REV, 4, 4, Goes::rgb_float},
};

const FormatRow* find_format(GLenum format) {
    const auto* at =
        std::find_if(kFormats.begin(), kFormats.end(), [&](const FormatRow& r) { return r.format == format; });
    return at == kFormats.end() ? nullptr : at;
}

const TypeRow* find_type(GLenum type) {
    const auto* at = std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeRow& r) { return r.type == type; });
    return at == kTypes.end() ? nullptr : at;
}

/// Mesa takes GL_ABGR_EXT only for these.
bool equal_components(GLenum type) {
    return type == GL_UNSIGNED_SHORT_4_4_4_4 || type == GL_UNSIGNED_SHORT_4_4_4_4_REV ||
           type == GL_UNSIGNED_INT_8_8_8_8 || type == GL_UNSIGNED_INT_8_8_8_8_REV;
}

bool packed_fits(const TypeRow& type, GLenum format) {
    switch (type.goes) {
        case Goes::rgb: return format == GL_RGB || format == GL_RGB_INTEGER;
        case Goes::rgba:
            if (format == GL_ABGR_EXT) return equal_components(type.type);
            return format == GL_RGBA || format == GL_BGRA || format == GL_RGBA_INTEGER || format == GL_BGRA_INTEGER;
        case Goes::depth_stencil: return format == GL_DEPTH_STENCIL;
        case Goes::rgb_float: return format == GL_RGB;
    }
    return false;
}

void swap_elements(std::byte* bytes, std::size_t size, unsigned element) {
    if (element < 2) return;
    for (std::size_t i = 0; i + element <= size; i += element) std::reverse(bytes + i, bytes + i + element);
}

std::byte reversed_bits(std::byte b) {
    auto v = std::to_integer<unsigned>(b);
    v = (v & 0xf0) >> 4 | (v & 0x0f) << 4;
    v = (v & 0xcc) >> 2 | (v & 0x33) << 2;
    return static_cast<std::byte>((v & 0xaa) >> 1 | (v & 0x55) << 1);
}

bool bit_at(const std::byte* row, std::size_t bit, bool lsb_first) {
    const unsigned shift = lsb_first ? bit % 8 : 7 - bit % 8;
    return (std::to_integer<unsigned>(row[bit / 8]) >> shift & 1) != 0;
}

void set_bit(std::byte* row, std::size_t bit, bool lsb_first, bool value) {
    const auto mask = static_cast<std::byte>(1u << (lsb_first ? bit % 8 : 7 - bit % 8));
    row[bit / 8] = value ? row[bit / 8] | mask : row[bit / 8] & ~mask;
}

void unpack_bits(const PixelStore& store, const std::byte* from, std::byte* to, std::int32_t width) {
    const auto skip = static_cast<std::size_t>(store.skip_pixels);
    const std::size_t bytes = (static_cast<std::size_t>(width) + 7) / 8;
    if (skip % 8 == 0) {
        std::memcpy(to, from + skip / 8, bytes);
        if (store.lsb_first) std::transform(to, to + bytes, to, reversed_bits);
    } else {
        std::memset(to, 0, bytes);
        for (std::int32_t i = 0; i < width; ++i)
            set_bit(to, static_cast<std::size_t>(i), false, bit_at(from, skip + i, store.lsb_first));
    }
    if (width % 8 != 0)
        to[bytes - 1] &=
            static_cast<std::byte>(0xff00u >> (width % 8));  // stray bits: none, so that equal images are equal
}

std::size_t image_offset(const PixelStore& store, std::size_t row_stride, const ImageSize& size, std::int32_t slice) {
    if (size.dimensions < 3) return 0;
    const std::size_t rows = static_cast<std::size_t>(store.image_height > 0 ? store.image_height : size.height);
    return row_stride * rows * static_cast<std::size_t>(store.skip_images + slice);
}

std::size_t row_stride(const PixelStore& store, const PixelLayout& layout, std::int32_t width) {
    const std::size_t bytes = row_bytes(layout, store.row_length > 0 ? store.row_length : width);
    const auto alignment = static_cast<std::size_t>(store.alignment);
    return (bytes + alignment - 1) / alignment * alignment;
}

}  // namespace

unsigned components_of(GLenum format) {
    const FormatRow* row = find_format(format);
    return row ? row->components : 0;
}

bool is_packed_type(GLenum type) {
    const TypeRow* row = find_type(type);
    return row && row->packed_bytes != 0;
}

bool is_integer_format(GLenum format) {
    const FormatRow* row = find_format(format);
    return row && row->integer;
}

// The order of the checks is Mesa's, so that the error is the same where two apply.
GLenum format_type_error(GLenum format, GLenum type) {
    const FormatRow* f = find_format(format);
    if (type == GL_BITMAP)
        return format == GL_COLOR_INDEX || format == GL_STENCIL_INDEX ? GL_NO_ERROR : GL_INVALID_ENUM;
    const TypeRow* t = find_type(type);
    if (t && t->packed_bytes != 0) {
        if (packed_fits(*t, format)) return GL_NO_ERROR;
        return type == GL_UNSIGNED_INT_5_9_9_9_REV ? GL_INVALID_ENUM : GL_INVALID_OPERATION;
    }
    if (!t || !f || format == GL_DEPTH_STENCIL || format == GL_INTENSITY) return GL_INVALID_ENUM;
    if (f->integer && !t->integers) return GL_INVALID_ENUM;
    return GL_NO_ERROR;
}

std::optional<PixelLayout> pixel_layout(GLenum format, GLenum type) {
    if (format_type_error(format, type) != GL_NO_ERROR) return std::nullopt;
    if (type == GL_BITMAP) return PixelLayout{0, 1, 1, true};
    const TypeRow& t = *find_type(type);
    const unsigned components = components_of(format);
    return PixelLayout{t.packed_bytes ? t.packed_bytes : t.element_bytes * components, t.element_bytes, components,
                       false};
}

std::size_t row_bytes(const PixelLayout& layout, std::int32_t width) {
    const auto pixels = static_cast<std::size_t>(width);
    return layout.bitmap ? (pixels + 7) / 8 : pixels * layout.pixel_bytes;
}

std::optional<std::size_t> image_bytes(GLenum format, GLenum type, std::int32_t width, std::int32_t height,
                                       std::int32_t depth) {
    const auto layout = pixel_layout(format, type);
    if (!layout || width < 0 || height < 0 || depth < 0) return std::nullopt;
    const std::uint64_t row = row_bytes(*layout, width);  // < 2^31 * 16
    if (row == 0 || height == 0 || depth == 0) return 0;
    if (row > kMaxImageBytes) return std::nullopt;
    const std::uint64_t slice = row * static_cast<std::uint64_t>(height);  // < 2^62
    if (slice > kMaxImageBytes || slice * static_cast<std::uint64_t>(depth) > kMaxImageBytes) return std::nullopt;
    return static_cast<std::size_t>(slice * static_cast<std::uint64_t>(depth));
}

std::size_t row_offset(const PixelStore& store, const PixelLayout& layout, const ImageSize& size, std::int32_t row,
                       std::int32_t slice) {
    const std::size_t stride = row_stride(store, layout, size.width);
    const std::size_t skip = layout.bitmap ? 0 : static_cast<std::size_t>(store.skip_pixels) * layout.pixel_bytes;
    return image_offset(store, stride, size, slice) + stride * static_cast<std::size_t>(store.skip_rows + row) + skip;
}

std::size_t memory_bytes(const PixelStore& store, const ImageSize& size, GLenum format, GLenum type) {
    const auto layout = pixel_layout(format, type);
    if (!layout || size.width <= 0 || size.height <= 0 || size.depth <= 0) return 0;
    const std::int32_t width = layout->bitmap ? store.skip_pixels + size.width : size.width;
    return row_offset(store, *layout, size, size.height - 1, size.depth - 1) + row_bytes(*layout, width);
}

std::vector<std::byte> unpack_image(const PixelStore& store, const ImageSize& size, GLenum format, GLenum type,
                                    const void* pixels) {
    const auto layout = pixel_layout(format, type);
    std::vector<std::byte> tight(image_bytes(format, type, size.width, size.height, size.depth).value_or(0));
    if (tight.empty() || !pixels) return tight;
    const auto* from = static_cast<const std::byte*>(pixels);
    const std::size_t bytes = row_bytes(*layout, size.width);
    std::byte* to = tight.data();
    if (!layout->bitmap && size.depth == 1 && row_stride(store, *layout, size.width) == bytes) {
        std::memcpy(to, from + row_offset(store, *layout, size, 0, 0), tight.size());
    } else {
        for (std::int32_t slice = 0; slice < size.depth; ++slice)
            for (std::int32_t row = 0; row < size.height; ++row, to += bytes) {
                const std::byte* at = from + row_offset(store, *layout, size, row, slice);
                if (layout->bitmap) unpack_bits(store, at, to, size.width);
                else std::memcpy(to, at, bytes);
            }
    }
    if (store.swap_bytes) swap_elements(tight.data(), tight.size(), layout->element_bytes);
    return tight;
}

void pack_image(const PixelStore& store, const ImageSize& size, GLenum format, GLenum type,
                std::span<const std::byte> tight, void* pixels) {
    const auto layout = pixel_layout(format, type);
    if (!layout || !pixels) return;
    const std::size_t bytes = row_bytes(*layout, size.width);
    const std::byte* from = tight.data();
    auto* to = static_cast<std::byte*>(pixels);
    for (std::int32_t slice = 0; slice < size.depth; ++slice)
        for (std::int32_t row = 0; row < size.height; ++row, from += bytes) {
            std::byte* at = to + row_offset(store, *layout, size, row, slice);
            if (layout->bitmap) {
                for (std::int32_t i = 0; i < size.width; ++i)
                    set_bit(at, static_cast<std::size_t>(store.skip_pixels + i), store.lsb_first,
                            bit_at(from, static_cast<std::size_t>(i), false));
                continue;
            }
            std::memcpy(at, from, bytes);
            if (store.swap_bytes) swap_elements(at, bytes, layout->element_bytes);
        }
}

void copy_rect(const PixelLayout& layout, const TightImage& to, std::int32_t to_x, std::int32_t to_y,
               const std::byte* from, std::int32_t from_width, std::int32_t width, std::int32_t height) {
    const std::size_t to_row = row_bytes(layout, to.width), from_row = row_bytes(layout, from_width);
    const std::size_t bytes = row_bytes(layout, width);
    std::byte* at =
        to.pixels + static_cast<std::size_t>(to_y) * to_row + static_cast<std::size_t>(to_x) * layout.pixel_bytes;
    for (std::int32_t row = 0; row < height; ++row, at += to_row, from += from_row) std::memcpy(at, from, bytes);
}

}  // namespace wall::glapi
