// SPDX-License-Identifier: MIT
// Group [draw_pieces]: how a large draw is cut. Render thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class DrawPiecesCommands {
public:
    /// `execution` outlives it.
    explicit DrawPiecesCommands(Execution& execution) : execution_(execution) {}

    void DrawPieces(ClientName pieces, std::uint32_t step, std::uint32_t overlap, std::span<const std::byte> boxes);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
