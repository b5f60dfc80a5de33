// SPDX-License-Identifier: MIT
// How many texture units there are, by what they are for (OpenGL 2.1, 2.7 and 3.8).
#pragma once

#include <algorithm>

#include "gen/glstate/state.gen.h"

namespace wall::client {

/// Of fixed function: with a switch, an environment. GL_MAX_TEXTURE_UNITS.
inline constexpr unsigned kTextureUnits = glstate::el::texture_2d_enabled::count;
/// Sets of coordinates, with their matrices and arrays. GL_MAX_TEXTURE_COORDS.
inline constexpr unsigned kTextureCoords = glstate::el::texcoord::count;
/// What textures are bound to and samplers name, in all kinds of shaders together. GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS.
inline constexpr unsigned kTextureImageUnits = glstate::el::texture_binding_2d::count;
/// That glActiveTexture may name.
inline constexpr unsigned kActiveTextures = std::max(kTextureCoords, kTextureImageUnits);

// What is set for the active unit by fixed function is an element of both of them, after one check.
static_assert(kTextureUnits == kTextureCoords);
static_assert(glstate::el::sampler_binding::count == kTextureImageUnits);

}  // namespace wall::client
