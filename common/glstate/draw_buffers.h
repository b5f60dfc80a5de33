// SPDX-License-Identifier: MIT
// What a state says of single draw buffers: elements with a bit for each of them (`bits` in proto/gl/state.toml), and
// what the words for a window's buffers mean. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "common/geom/view.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {

/// That elements have a bit for.
inline constexpr unsigned kDrawBuffers = 8;
/// Viewports, each with a scissor box and a depth range, of which a geometry shader may choose one.
inline constexpr unsigned kViewports = 1 + el::viewport_rest::count;

/// Whose buffers alone a word for buffers of a window names (OpenGL 4.6, table 17.4). Where it names one of each eye's
/// (both), the left one is read.
constexpr geom::Eye eye_of(std::uint32_t buffer) {
    switch (buffer) {
        case GL_FRONT_LEFT:
        case GL_BACK_LEFT:
        case GL_LEFT: return geom::Eye::left;
        case GL_FRONT_RIGHT:
        case GL_BACK_RIGHT:
        case GL_RIGHT: return geom::Eye::right;
        default: return geom::Eye::both;
    }
}
/// Only back buffers: what is drawn shows with the next swap.
constexpr bool names_back_only(std::uint32_t buffer) {
    return buffer == GL_BACK || buffer == GL_BACK_LEFT || buffer == GL_BACK_RIGHT;
}

/// Whether red, green, blue and alpha of that draw buffer are written.
inline std::array<bool, 4> written_channels(const State& state, unsigned buffer) {
    const ColorMask& mask = state.color_buffer.color_mask;
    const auto written = [&](std::uint32_t bits) { return (bits >> buffer & 1) != 0; };
    return {written(mask.red), written(mask.green), written(mask.blue), written(mask.alpha)};
}

/// Whether nothing of the first one, which is the only one of a window, is kept by the colour mask.
inline bool writes_all_channels(const State& state) {
    return written_channels(state, 0) == std::array<bool, 4>{true, true, true, true};
}

/// `bits` with that of one draw buffer set to `on`.
inline std::uint32_t with_bit(std::uint32_t bits, unsigned buffer, bool on) {
    const std::uint32_t bit = 1u << buffer;
    return on ? bits | bit : bits & ~bit;
}

/// Whether a query counts primitives, which then go to all tiles as they are, so that each node sees all of them.
inline bool counts_primitives(const State& state) {
    std::uint32_t any = 0;  // without a branch: each switch between contexts asks
    for (const std::uint32_t query : state.objects.primitives_query) any |= query;
    for (const std::uint32_t query : state.objects.captured_query) any |= query;
    return any != 0;
}

}  // namespace wall::glstate
