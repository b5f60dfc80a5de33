// SPDX-License-Identifier: MIT
#include "client_lib/objects/small_floats.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace wall::client {
namespace {

/// A half without a sign and with fewer bits of mantissa.
std::uint32_t short_float(float value, unsigned mantissa_bits) {
    constexpr int kMostExponent = 15;
    const std::uint32_t infinity = 31u << mantissa_bits;
    if (std::isnan(value)) return infinity | 1;
    if (!(value > 0)) return 0;
    if (std::isinf(value)) return infinity;
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const int exponent = static_cast<int>(bits >> 23) - 127;
    if (exponent > kMostExponent) return infinity - 1;
    if (exponent <= -kMostExponent) return 0;
    const std::uint32_t mantissa = (bits & 0x7fffff) >> (23 - mantissa_bits);
    return static_cast<std::uint32_t>(exponent + kMostExponent) << mantissa_bits | mantissa;
}

}  // namespace

std::uint16_t float_to_half(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000);
    const float magnitude = std::fabs(value);
    if (std::isnan(value)) return sign | 0x7e00;
    if (magnitude >= 65520.0f) return sign | 0x7c00;
    if (magnitude < 6.103515625e-05f) return sign | static_cast<std::uint16_t>(std::lrint(std::ldexp(magnitude, 24)));
    int exponent;
    const float fraction = std::frexp(magnitude, &exponent);                                 // [0.5, 1)
    const auto mantissa = static_cast<std::uint32_t>(std::lrint(std::ldexp(fraction, 11)));  // [1024, 2048]
    return static_cast<std::uint16_t>(sign | ((static_cast<std::uint32_t>(exponent + 13) << 10) + mantissa));
}

std::uint16_t float_to_half_cut(float value) {
    const std::uint16_t half = float_to_half(value);
    const bool grew = std::isfinite(value) && std::fabs(half_to_float(half)) > std::fabs(value);
    return static_cast<std::uint16_t>(grew ? half - 1 : half);
}

Rgb from_short_floats(std::uint32_t word) {
    return {half_to_float(static_cast<std::uint16_t>((word & 0x7ff) << 4)),
            half_to_float(static_cast<std::uint16_t>((word >> 11 & 0x7ff) << 4)),
            half_to_float(static_cast<std::uint16_t>((word >> 22) << 5))};
}

std::uint32_t to_short_floats(const Rgb& colors) {
    return short_float(colors[0], 6) | short_float(colors[1], 6) << 11 | short_float(colors[2], 5) << 22;
}

Rgb from_shared_exponent(std::uint32_t word) {
    const float scale = std::ldexp(1.0f, static_cast<int>(word >> 27) - 24);
    Rgb colors;
    for (unsigned i = 0; i < 3; ++i) colors[i] = static_cast<float>(word >> 9 * i & 0x1ff) * scale;
    return colors;
}

std::uint32_t to_shared_exponent(const Rgb& colors) {
    constexpr int kBias = 15, kMantissa = 9;
    constexpr float kMost = 65408.0f;  // 511 / 512 * 2^16
    Rgb c;
    for (unsigned i = 0; i < 3; ++i) c[i] = colors[i] > 0 ? std::min(colors[i], kMost) : 0.0f;
    const float largest = std::max({c[0], c[1], c[2]});
    int exponent = (largest > 0 ? std::max(-kBias - 1, std::ilogb(largest)) : -kBias - 1) + 1 + kBias;
    const auto mantissa = [&](float value) {
        return std::floor(std::ldexp(value, kBias + kMantissa - exponent) + 0.5f);
    };
    if (mantissa(largest) >= 1 << kMantissa) ++exponent;
    std::uint32_t word = static_cast<std::uint32_t>(exponent) << 27;
    for (unsigned i = 0; i < 3; ++i) word |= static_cast<std::uint32_t>(mantissa(c[i])) << (kMantissa * i);
    return word;
}

}  // namespace wall::client
