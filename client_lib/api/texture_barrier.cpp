// SPDX-License-Identifier: MIT
// glTextureBarrier (OpenGL 4.5, 9.3.1): a program may sample what it draws to; those who draw are told when.
#include <optional>

#include "client_lib/context/context.h"
#include "client_lib/geometry/needs.h"

namespace wall::client::api {

void TextureBarrier(Context& c) {
    if (!c.draw_target()) return;
    c.draw(std::nullopt, needs_of_clear(), [](wire::PackBuffer& buffer) { glapi::pack::TextureBarrier(buffer); });
}

}  // namespace wall::client::api
