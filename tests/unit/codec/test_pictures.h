// SPDX-License-Identifier: MIT
// Pictures for the codec tests, all from a seed. Every kind stresses something else of a codec.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "common/codec/codec.h"

namespace wall::codec::test {

enum class Kind { flat, noise, gradient, noisy_gradient, text, sparse };
inline constexpr std::array kKinds{Kind::flat,           Kind::noise, Kind::gradient,
                                   Kind::noisy_gradient, Kind::text,  Kind::sparse};

inline std::uint8_t sample_of(Kind kind, std::uint32_t x, std::uint32_t y, std::size_t channel, std::mt19937& random) {
    const auto ramp = static_cast<std::uint8_t>((x * (channel + 1) + y * 3) / 7);
    switch (kind) {
        case Kind::flat: return static_cast<std::uint8_t>(40 * (channel + 1));
        case Kind::noise: return static_cast<std::uint8_t>(random());
        case Kind::gradient: return ramp;
        case Kind::noisy_gradient: return static_cast<std::uint8_t>(ramp + random() % 5);
        case Kind::text: return (x * 2654435761u ^ (y / 2) * 40503u) >> 13 & 1 && x / 20 % 2 == 0 ? 30 : 250;
        case Kind::sparse: return random() % 97 == 0 ? static_cast<std::uint8_t>(random()) : 7;
    }
    return 0;
}

/// A picture of the kind; without alpha in the format, its alpha is 255.
inline Picture picture(const StreamFormat& format, Kind kind, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    Picture out(format);
    const std::size_t pixel = bytes_per_pixel(format.layout);
    for (std::uint32_t y = 0; y < format.height; ++y)
        for (std::uint32_t x = 0; x < format.width; ++x)
            for (std::size_t c = 0; c < pixel; ++c)
                out.row(y)[x * pixel + c] =
                    static_cast<std::byte>(c == 3 && !format.alpha ? 255 : sample_of(kind, x + seed, y, c, random));
    return out;
}

/// The pixels of a view in a row, whatever its stride.
inline std::vector<std::byte> bytes_of(const FrameView& view) {
    std::vector<std::byte> out(view.row_bytes() * view.height);
    for (std::uint32_t y = 0; y < view.height; ++y)
        std::memcpy(out.data() + y * view.row_bytes(), view.row(y), view.row_bytes());
    return out;
}

inline std::string describe(const StreamFormat& format, Kind kind) {
    return std::to_string(format.width) + "x" + std::to_string(format.height) + " " +
           std::string(name_of(format.layout)) + (format.alpha ? " with alpha" : "") + ", kind " +
           std::to_string(static_cast<int>(kind));
}

}  // namespace wall::codec::test
