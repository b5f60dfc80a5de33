// SPDX-License-Identifier: MIT
// What an assembly program reads, as its tokens say. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/glapi/assembly_format.h"
#include "tileserver/objects/assembly_tokens.h"

namespace wall::tileserver {

/// The textures that a fragment program looks up, each once. Whatever stands around it: "texture[n], TARGET" can be
/// nothing else.
std::vector<glapi::AssemblyTexture> find_textures(std::span<const AssemblyToken> tokens);

/// The generic attributes that a vertex program reads, a bit each. Number 0 is the position.
std::uint32_t find_generic_attributes(std::span<const AssemblyToken> tokens);

}  // namespace wall::tileserver
