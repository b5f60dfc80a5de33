// SPDX-License-Identifier: MIT
// A small picture that uses every way to make fragments: triangles, lines, points, stipples, images, bitmaps, textures.
#pragma once

#include "tileserver/gpu/gl.h"

namespace wall::tileserver::test {

void draw_scene(const Gl& gl, int width, int height);

}  // namespace wall::tileserver::test
