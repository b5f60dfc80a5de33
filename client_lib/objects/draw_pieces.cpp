// SPDX-License-Identifier: MIT
#include "client_lib/objects/draw_pieces.h"

#include <span>

#include "gen/glapi/wire.gen.h"

namespace wall::client {

void DrawPieces::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    glapi::pack::DrawPieces(buffer, id, cut_.step, cut_.overlap, std::as_bytes(std::span(boxes_)));
    packed();
}

}  // namespace wall::client
