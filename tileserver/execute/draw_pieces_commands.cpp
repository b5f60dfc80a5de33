// SPDX-License-Identifier: MIT
#include "tileserver/execute/draw_pieces_commands.h"

#include "tileserver/objects/draw_pieces.h"

namespace wall::tileserver {

void DrawPiecesCommands::DrawPieces(ClientName name, std::uint32_t step, std::uint32_t overlap,
                                    std::span<const std::byte> boxes) {
    if (step == 0 || overlap > step || boxes.size() % sizeof(glstate::PieceBox) != 0 ||
        boxes.size() / sizeof(glstate::PieceBox) > glstate::kMostPieces)
        return execution_.refuse("no pieces of a draw");
    const auto pieces = execution_.session.objects.make<tileserver::DrawPieces>(name);
    if (!pieces) return execution_.refuse(pieces.error().message);
    if (!(*pieces)->define({step, overlap}, boxes)) execution_.refuse(too_much("memory of objects"));
}

}  // namespace wall::tileserver
