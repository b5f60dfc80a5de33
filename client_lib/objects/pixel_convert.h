// SPDX-License-Identifier: MIT
// Pixels between formats, by way of floating point RGBA, and pixel transfer (OpenGL 1.2.1, 3.6.4 and 4.3.2), for the
// few cases where the client itself must see pixels: textures defined while a transfer is set, glGetTexImage,
// sub-images in another format. Everything else is converted by the node's driver. Pure.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/glapi/image.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

using Rgba = std::array<float, 4>;

/// The ten maps of glPixelMap; sizes are at least 1.
struct PixelMapTables {
    static constexpr unsigned kMaps = 10;
    std::array<std::vector<float>, kMaps> tables;
    PixelMapTables() { tables.fill({0.0f}); }
    const std::vector<float>& of(GLenum map) const { return tables[map - GL_PIXEL_MAP_I_TO_I]; }
};

/// Tight pixels as RGBA; missing components are 0, alpha 1. Depth, stencil and indices: in the first component.
std::vector<Rgba> to_rgba(GLenum format, GLenum type, std::span<const std::byte> tight, std::size_t pixels);
/// The components of a texel of whole numbers.
using Whole = std::array<std::int64_t, 4>;
/// The same of the *_INTEGER formats, every bit kept.
std::vector<Whole> to_whole(GLenum format, GLenum type, std::span<const std::byte> tight, std::size_t pixels);
/// Each to the nearest that the type holds.
std::vector<std::byte> from_whole(GLenum format, GLenum type, std::span<const Whole> pixels);

/// Indices (GL_COLOR_INDEX, GL_STENCIL_INDEX), bitmaps included (`width` pixels a row), shift, offset and maps not
/// applied.
std::vector<float> to_indices(GLenum type, std::span<const std::byte> tight, std::int32_t width, std::int32_t rows);
/// Luminance is taken from red.
std::vector<std::byte> from_rgba(GLenum format, GLenum type, std::span<const Rgba> pixels);

/// Whether pixel transfer would change colours or depths.
bool transfer_matters(const glstate::State& state, GLenum format);
/// Scale, bias and colour maps.
void transfer_colors(const glstate::State& state, const PixelMapTables& maps, std::span<Rgba> pixels);
void transfer_depths(const glstate::State& state, std::span<Rgba> pixels);
/// Shift and offset, then the maps from index to colour.
std::vector<Rgba> indices_to_colors(const glstate::State& state, const PixelMapTables& maps,
                                    std::span<const float> indices);

}  // namespace wall::client
