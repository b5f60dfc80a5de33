// SPDX-License-Identifier: MIT
// The two kinds of OpenGL ES: the first, 1.1, has fixed function and no shaders, the later ones shaders only. Versions
// are times ten. Pure.
#pragma once

namespace wall::client {

inline constexpr unsigned kFirstShaderEs = 20;
/// 0: of no OpenGL ES.
constexpr bool is_first_es(unsigned version) { return version != 0 && version < kFirstShaderEs; }

}  // namespace wall::client
