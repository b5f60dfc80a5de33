// SPDX-License-Identifier: MIT
// glTextureBarrier (OpenGL 4.5, 9.3.1) and glBlendBarrier (OpenGL ES 3.2, 15.1.5.1): a program may sample what it draws
// to, and blend with it by advanced equations; those who draw are told when.
#include <optional>

#include "client_lib/context/context.h"
#include "client_lib/geometry/needs.h"

namespace wall::client::api {

void TextureBarrier(Context& c) {
    if (!c.draw_target()) return;
    c.draw(std::nullopt, needs_of_clear(), [](wire::PackBuffer& buffer) { glapi::pack::TextureBarrier(buffer); });
}

void BlendBarrier(Context& c) {
    if (!c.draw_target()) return;
    c.draw(std::nullopt, needs_of_clear(), [](wire::PackBuffer& buffer) { glapi::pack::BlendBarrier(buffer); });
}

}  // namespace wall::client::api
