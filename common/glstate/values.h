// SPDX-License-Identifier: MIT
// Value types of state elements: trivially copyable, a multiple of 4 bytes, no padding, so that they travel and compare
// as bytes. Pure.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace wall::glstate {

using Flag = std::uint32_t;  ///< 0 or 1
using Vec2 = std::array<float, 2>;
using Vec3 = std::array<float, 3>;
using Vec4 = std::array<float, 4>;
using Mat4 = std::array<float, 16>;  ///< column major
using Words32 = std::array<std::uint32_t, 32>;

/// Numbers of which all bits are set (indexed_values.h).
inline constexpr float kAllBits = std::bit_cast<float>(~std::uint32_t{0});
inline constexpr double kAllBits64 = std::bit_cast<double>(~std::uint64_t{0});

inline constexpr Mat4 kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// An array with the same value everywhere.
template <class Array>
constexpr Array filled(const typename Array::value_type& value) {
    Array array{};
    for (auto& v : array) v = value;
    return array;
}

template <class... E>
struct ElementList {
    static constexpr std::size_t size = sizeof...(E);
};

}  // namespace wall::glstate
