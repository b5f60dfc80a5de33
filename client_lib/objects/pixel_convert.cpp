// SPDX-License-Identifier: MIT
#include "client_lib/objects/pixel_convert.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "client_lib/objects/small_floats.h"

namespace wall::client {
namespace {

template <class T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

double unsigned_max(unsigned bits) { return bits == 32 ? 4294967295.0 : static_cast<double>((1u << bits) - 1); }

/// By the reciprocal, as Mesa does it: the last bit may differ from a division's.
float unorm(std::uint32_t value, unsigned bits) {
    return bits > 16 ? static_cast<float>(value / unsigned_max(bits))
                     : static_cast<float>(value) * (1.0f / static_cast<float>(unsigned_max(bits)));
}
float snorm(std::int32_t value, unsigned bits) {
    return static_cast<float>(
        std::max(value / (bits == 32 ? 2147483647.0 : static_cast<double>((1 << (bits - 1)) - 1)), -1.0));
}
std::uint32_t to_unorm(float value, unsigned bits) {
    if (!(value > 0)) return 0;
    if (value >= 1) return static_cast<std::uint32_t>(unsigned_max(bits));
    return static_cast<std::uint32_t>(std::llrint(value * unsigned_max(bits)));
}
std::uint32_t to_number(float value, std::uint32_t max) {
    return value > 0 ? static_cast<std::uint32_t>(std::min(static_cast<double>(value), static_cast<double>(max))) : 0;
}
std::int32_t to_snorm(float value, unsigned bits) {
    const double max = bits == 32 ? 2147483647.0 : static_cast<double>((1 << (bits - 1)) - 1);
    return static_cast<std::int32_t>(std::llrint(std::clamp(static_cast<double>(value), -1.0, 1.0) * max));
}

/// One component of a type that is not packed; `whole`: the number itself, not normalized.
float load_component(GLenum type, const std::byte* at, bool whole) {
    switch (type) {
        case GL_UNSIGNED_BYTE: return whole ? load<std::uint8_t>(at) : unorm(load<std::uint8_t>(at), 8);
        case GL_BYTE: return whole ? load<std::int8_t>(at) : snorm(load<std::int8_t>(at), 8);
        case GL_UNSIGNED_SHORT: return whole ? load<std::uint16_t>(at) : unorm(load<std::uint16_t>(at), 16);
        case GL_SHORT: return whole ? load<std::int16_t>(at) : snorm(load<std::int16_t>(at), 16);
        case GL_UNSIGNED_INT:
            return whole ? static_cast<float>(load<std::uint32_t>(at)) : unorm(load<std::uint32_t>(at), 32);
        case GL_INT: return whole ? static_cast<float>(load<std::int32_t>(at)) : snorm(load<std::int32_t>(at), 32);
        case GL_HALF_FLOAT: return half_to_float(load<std::uint16_t>(at));
        default: return load<float>(at);
    }
}

template <class T>
void store(std::byte* at, T value) {
    std::memcpy(at, &value, sizeof value);
}

void store_component(GLenum type, std::byte* at, float value, bool whole) {
    const auto number = static_cast<std::int64_t>(value);
    switch (type) {
        case GL_UNSIGNED_BYTE: return store(at, static_cast<std::uint8_t>(whole ? number : to_unorm(value, 8)));
        case GL_BYTE: return store(at, static_cast<std::int8_t>(whole ? number : to_snorm(value, 8)));
        case GL_UNSIGNED_SHORT: return store(at, static_cast<std::uint16_t>(whole ? number : to_unorm(value, 16)));
        case GL_SHORT: return store(at, static_cast<std::int16_t>(whole ? number : to_snorm(value, 16)));
        case GL_UNSIGNED_INT: return store(at, static_cast<std::uint32_t>(whole ? number : to_unorm(value, 32)));
        case GL_INT: return store(at, static_cast<std::int32_t>(whole ? number : to_snorm(value, 32)));
        case GL_HALF_FLOAT: return store(at, float_to_half(value));
        default: return store(at, value);
    }
}

std::int64_t load_whole(GLenum type, const std::byte* at) {
    switch (type) {
        case GL_UNSIGNED_BYTE: return load<std::uint8_t>(at);
        case GL_BYTE: return load<std::int8_t>(at);
        case GL_UNSIGNED_SHORT: return load<std::uint16_t>(at);
        case GL_SHORT: return load<std::int16_t>(at);
        case GL_UNSIGNED_INT: return load<std::uint32_t>(at);
        default: return load<std::int32_t>(at);
    }
}

template <class T>
void store_nearest(std::byte* at, std::int64_t value) {
    using Limits = std::numeric_limits<T>;
    store(at, static_cast<T>(std::clamp(value, std::int64_t{Limits::min()}, std::int64_t{Limits::max()})));
}

void store_whole(GLenum type, std::byte* at, std::int64_t value) {
    switch (type) {
        case GL_UNSIGNED_BYTE: return store_nearest<std::uint8_t>(at, value);
        case GL_BYTE: return store_nearest<std::int8_t>(at, value);
        case GL_UNSIGNED_SHORT: return store_nearest<std::uint16_t>(at, value);
        case GL_SHORT: return store_nearest<std::int16_t>(at, value);
        case GL_UNSIGNED_INT: return store_nearest<std::uint32_t>(at, value);
        default: return store_nearest<std::int32_t>(at, value);
    }
}

/// Bits of a packed type's components in the order of the format, from the highest or (reversed) the lowest bit.
struct PackedBits {
    std::array<unsigned, 4> bits;
    bool reversed;
};

PackedBits packed_bits(GLenum type) {
    switch (type) {
        case GL_UNSIGNED_BYTE_3_3_2: return {{3, 3, 2, 0}, false};
        case GL_UNSIGNED_BYTE_2_3_3_REV: return {{3, 3, 2, 0}, true};
        case GL_UNSIGNED_SHORT_5_6_5: return {{5, 6, 5, 0}, false};
        case GL_UNSIGNED_SHORT_5_6_5_REV: return {{5, 6, 5, 0}, true};
        case GL_UNSIGNED_SHORT_4_4_4_4: return {{4, 4, 4, 4}, false};
        case GL_UNSIGNED_SHORT_4_4_4_4_REV: return {{4, 4, 4, 4}, true};
        case GL_UNSIGNED_SHORT_5_5_5_1: return {{5, 5, 5, 1}, false};
        case GL_UNSIGNED_SHORT_1_5_5_5_REV: return {{5, 5, 5, 1}, true};
        case GL_UNSIGNED_INT_8_8_8_8: return {{8, 8, 8, 8}, false};
        case GL_UNSIGNED_INT_8_8_8_8_REV: return {{8, 8, 8, 8}, true};
        case GL_UNSIGNED_INT_10_10_10_2: return {{10, 10, 10, 2}, false};
        default: return {{10, 10, 10, 2}, true};
    }
}

unsigned shift_of(const PackedBits& packed, unsigned component, unsigned total) {
    unsigned before = 0;
    for (unsigned i = 0; i < component; ++i) before += packed.bits[i];
    return packed.reversed ? before : total - before - packed.bits[component];
}

std::uint32_t load_word(const std::byte* at, unsigned bytes) {
    std::uint32_t word = 0;
    std::memcpy(&word, at, bytes);
    return word;
}

/// Which of red, green, blue, alpha each component of a format is; 4: luminance, 5: intensity.
struct Order {
    std::array<std::uint8_t, 4> place;
    unsigned count;
};
constexpr std::uint8_t kLuminance = 4, kIntensity = 5;

Order order_of(GLenum format) {
    switch (format) {
        case GL_GREEN:
        case GL_GREEN_INTEGER: return {{1}, 1};
        case GL_BLUE:
        case GL_BLUE_INTEGER: return {{2}, 1};
        case GL_ALPHA:
        case GL_ALPHA_INTEGER: return {{3}, 1};
        case GL_LUMINANCE:
        case GL_LUMINANCE_INTEGER_EXT: return {{kLuminance}, 1};
        case GL_LUMINANCE_ALPHA:
        case GL_LUMINANCE_ALPHA_INTEGER_EXT: return {{kLuminance, 3}, 2};
        case GL_INTENSITY: return {{kIntensity}, 1};
        case GL_RG:
        case GL_RG_INTEGER: return {{0, 1}, 2};
        case GL_RGB:
        case GL_RGB_INTEGER: return {{0, 1, 2}, 3};
        case GL_BGR:
        case GL_BGR_INTEGER: return {{2, 1, 0}, 3};
        case GL_RGBA:
        case GL_RGBA_INTEGER: return {{0, 1, 2, 3}, 4};
        case GL_BGRA:
        case GL_BGRA_INTEGER: return {{2, 1, 0, 3}, 4};
        case GL_ABGR_EXT: return {{3, 2, 1, 0}, 4};
        default: return {{0}, 1};  // red, depth, indices
    }
}

/// One component of a packed type, as it lies there.
std::uint32_t packed_component(std::uint32_t word, const PackedBits& bits, unsigned component,
                               const glapi::PixelLayout& layout) {
    return word >> shift_of(bits, component, layout.pixel_bytes * 8) & ((1u << bits.bits[component]) - 1);
}

template <class Number>
void put_component(std::array<Number, 4>& pixel, std::uint8_t place, Number value) {
    if (place == kLuminance) pixel[0] = pixel[1] = pixel[2] = value;
    else if (place == kIntensity) pixel.fill(value);
    else pixel[place] = value;
}

template <class Number>
Number get_component(const std::array<Number, 4>& pixel, std::uint8_t place) {
    return place >= kLuminance ? pixel[0] : pixel[place];
}

bool whole_numbers(GLenum format) {
    return format == GL_COLOR_INDEX || format == GL_STENCIL_INDEX || glapi::is_integer_format(format);
}

float looked_up(const std::vector<float>& table, float value) {
    const auto last = static_cast<float>(table.size() - 1);
    return table[static_cast<std::size_t>(std::lrint(std::clamp(value, 0.0f, 1.0f) * last))];
}

float looked_up_index(const std::vector<float>& table, float index) {
    return table[static_cast<std::size_t>(static_cast<std::int64_t>(index)) & (table.size() - 1)];
}

Rgb rgb_of(const Rgba& pixel) { return {pixel[0], pixel[1], pixel[2]}; }

}  // namespace

std::vector<Rgba> to_rgba(GLenum format, GLenum type, std::span<const std::byte> tight, std::size_t pixels) {
    std::vector<Rgba> out(pixels, Rgba{0, 0, 0, 1});
    const auto layout = glapi::pixel_layout(format, type);
    if (!layout || layout->bitmap) return out;
    const Order order = order_of(format);
    const bool whole = whole_numbers(format), packed = glapi::is_packed_type(type);
    const PackedBits bits = packed_bits(type);
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::byte* at = tight.data() + i * layout->pixel_bytes;
        if (type == GL_FLOAT_32_UNSIGNED_INT_24_8_REV) {
            out[i] = {load<float>(at), static_cast<float>(load<std::uint32_t>(at + 4) & 0xff), 0, 1};
        } else if (type == GL_UNSIGNED_INT_24_8) {
            out[i] = {unorm(load<std::uint32_t>(at) >> 8, 24), static_cast<float>(load<std::uint32_t>(at) & 0xff), 0,
                      1};
        } else if (type == GL_UNSIGNED_INT_5_9_9_9_REV || type == GL_UNSIGNED_INT_10F_11F_11F_REV) {
            const auto word = load<std::uint32_t>(at);
            const auto rgb = type == GL_UNSIGNED_INT_5_9_9_9_REV ? from_shared_exponent(word) : from_short_floats(word);
            out[i] = {rgb[0], rgb[1], rgb[2], 1};
        } else if (packed) {
            const std::uint32_t word = load_word(at, layout->pixel_bytes);
            for (unsigned k = 0; k < order.count; ++k) {
                const std::uint32_t value = packed_component(word, bits, k, *layout);
                put_component(out[i], order.place[k], whole ? static_cast<float>(value) : unorm(value, bits.bits[k]));
            }
        } else {
            for (unsigned k = 0; k < order.count; ++k)
                put_component(out[i], order.place[k], load_component(type, at + k * layout->element_bytes, whole));
        }
    }
    return out;
}

std::vector<Whole> to_whole(GLenum format, GLenum type, std::span<const std::byte> tight, std::size_t pixels) {
    std::vector<Whole> out(pixels, Whole{0, 0, 0, 1});
    const auto layout = glapi::pixel_layout(format, type);
    if (!layout || layout->bitmap) return out;
    const Order order = order_of(format);
    const PackedBits bits = packed_bits(type);
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::byte* at = tight.data() + i * layout->pixel_bytes;
        for (unsigned k = 0; k < order.count; ++k)
            put_component(out[i], order.place[k],
                          glapi::is_packed_type(type)
                              ? std::int64_t{packed_component(load_word(at, layout->pixel_bytes), bits, k, *layout)}
                              : load_whole(type, at + k * layout->element_bytes));
    }
    return out;
}

std::vector<std::byte> from_whole(GLenum format, GLenum type, std::span<const Whole> pixels) {
    const auto layout = glapi::pixel_layout(format, type);
    if (!layout || layout->bitmap) return {};
    std::vector<std::byte> out(pixels.size() * layout->pixel_bytes);
    const Order order = order_of(format);
    const PackedBits bits = packed_bits(type);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        std::byte* at = out.data() + i * layout->pixel_bytes;
        std::uint32_t word = 0;
        for (unsigned k = 0; k < order.count; ++k) {
            const std::int64_t value = get_component(pixels[i], order.place[k]);
            if (glapi::is_packed_type(type)) {
                const std::int64_t most = (std::int64_t{1} << bits.bits[k]) - 1;
                word |= static_cast<std::uint32_t>(std::clamp<std::int64_t>(value, 0, most))
                        << shift_of(bits, k, layout->pixel_bytes * 8);
            } else {
                store_whole(type, at + k * layout->element_bytes, value);
            }
        }
        if (glapi::is_packed_type(type)) std::memcpy(at, &word, layout->pixel_bytes);
    }
    return out;
}

std::vector<float> to_indices(GLenum type, std::span<const std::byte> tight, std::int32_t width, std::int32_t rows) {
    std::vector<float> out;
    out.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows));
    const auto layout = glapi::pixel_layout(GL_COLOR_INDEX, type);
    if (!layout) return out;
    const std::size_t stride = glapi::row_bytes(*layout, width);
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < width; ++x) {
            const std::byte* row = tight.data() + static_cast<std::size_t>(y) * stride;
            out.push_back(layout->bitmap
                              ? static_cast<float>(std::to_integer<unsigned>(row[x / 8]) >> (7 - x % 8) & 1)
                              : load_component(type, row + static_cast<std::size_t>(x) * layout->pixel_bytes, true));
        }
    return out;
}

std::vector<std::byte> from_rgba(GLenum format, GLenum type, std::span<const Rgba> pixels) {
    const auto layout = glapi::pixel_layout(format, type);
    if (!layout || layout->bitmap) return {};
    std::vector<std::byte> out(pixels.size() * layout->pixel_bytes);
    const Order order = order_of(format);
    const bool whole = whole_numbers(format), packed = glapi::is_packed_type(type);
    const PackedBits bits = packed_bits(type);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        std::byte* at = out.data() + i * layout->pixel_bytes;
        if (type == GL_UNSIGNED_INT_24_8) {
            store(at, to_unorm(pixels[i][0], 24) << 8 | to_number(pixels[i][1], 0xff));
        } else if (type == GL_FLOAT_32_UNSIGNED_INT_24_8_REV) {
            store(at, pixels[i][0]);
            store(at + 4, to_number(pixels[i][1], 0xff));
        } else if (type == GL_UNSIGNED_INT_5_9_9_9_REV) {
            store(at, to_shared_exponent(rgb_of(pixels[i])));
        } else if (type == GL_UNSIGNED_INT_10F_11F_11F_REV) {
            store(at, to_short_floats(rgb_of(pixels[i])));
        } else if (packed) {
            std::uint32_t word = 0;
            for (unsigned k = 0; k < order.count; ++k) {
                const float value = get_component(pixels[i], order.place[k]);
                const std::uint32_t max = (1u << bits.bits[k]) - 1;
                const std::uint32_t number = whole ? to_number(value, max) : to_unorm(value, bits.bits[k]);
                word |= number << shift_of(bits, k, layout->pixel_bytes * 8);
            }
            std::memcpy(at, &word, layout->pixel_bytes);
        } else {
            for (unsigned k = 0; k < order.count; ++k)
                store_component(type, at + k * layout->element_bytes, get_component(pixels[i], order.place[k]), whole);
        }
    }
    return out;
}

bool transfer_matters(const glstate::State& state, GLenum format) {
    const auto& t = state.pixel_transfer;
    if (format == GL_COLOR_INDEX) return true;  // only the maps give it a colour
    if (format == GL_DEPTH_COMPONENT || format == GL_DEPTH_STENCIL) return t.depth_scale != 1 || t.depth_bias != 0;
    if (format == GL_STENCIL_INDEX || glapi::is_integer_format(format)) return false;
    return t.map_color || t.red_scale != 1 || t.red_bias != 0 || t.green_scale != 1 || t.green_bias != 0 ||
           t.blue_scale != 1 || t.blue_bias != 0 || t.alpha_transfer_scale != 1 || t.alpha_transfer_bias != 0;
}

void transfer_colors(const glstate::State& state, const PixelMapTables& maps, std::span<Rgba> pixels) {
    const auto& t = state.pixel_transfer;
    const Rgba scale = {t.red_scale, t.green_scale, t.blue_scale, t.alpha_transfer_scale};
    const Rgba bias = {t.red_bias, t.green_bias, t.blue_bias, t.alpha_transfer_bias};
    for (Rgba& pixel : pixels)
        for (unsigned i = 0; i < 4; ++i) {
            pixel[i] = pixel[i] * scale[i] + bias[i];
            if (t.map_color) pixel[i] = looked_up(maps.of(GL_PIXEL_MAP_R_TO_R + i), pixel[i]);
        }
}

void transfer_depths(const glstate::State& state, std::span<Rgba> pixels) {
    const auto& t = state.pixel_transfer;
    for (Rgba& pixel : pixels) pixel[0] = std::clamp(pixel[0] * t.depth_scale + t.depth_bias, 0.0f, 1.0f);
}

std::vector<Rgba> indices_to_colors(const glstate::State& state, const PixelMapTables& maps,
                                    std::span<const float> indices) {
    const auto& t = state.pixel_transfer;
    std::vector<Rgba> out;
    out.reserve(indices.size());
    for (float index : indices) {
        index = static_cast<float>(std::ldexp(index, t.index_shift)) + static_cast<float>(t.index_offset);
        Rgba pixel;
        for (unsigned i = 0; i < 4; ++i) pixel[i] = looked_up_index(maps.of(GL_PIXEL_MAP_I_TO_R + i), index);
        out.push_back(pixel);
    }
    return out;
}

}  // namespace wall::client
