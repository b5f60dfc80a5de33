// SPDX-License-Identifier: MIT
// Blocks: commands that are executed once for each tile of a set. Before a block draws in a tile, the driver is brought
// from what it holds to the soft context (lazily, by diff) and the tile's layer, or the framebuffer object, is bound.
// Render thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tileserver/execute/execution.h"
#include "tileserver/execute/geometry_commands.h"

namespace wall::tileserver {

class BlockExecution {
public:
    /// Both outlive it.
    BlockExecution(Execution& execution, GeometryCommands& geometry)
        : execution_(execution), geometry_(geometry), block_(geometry.block()) {}

    /// The tiles to execute a block for, out of `tiles`. `bytes`: that it takes in the batch.
    std::uint64_t begin(std::uint64_t tiles, std::size_t bytes);
    void begin_tile(unsigned slot);
    /// The open tile is to be begun once more: for the other eye, of a window that has buffers for two.
    bool another_pass();
    void end();

    /// Others draw meanwhile: the driver is left in the middle of nothing.
    void pause();
    /// Others have drawn, and the tiles may be others.
    void resume();

private:
    void note_switch();
    void mark_time();
    /// Of the open tile; it draws if that can be drawn to.
    void find_target();
    Layer* find_layer() const;
    PartialLayers& partials() const;
    void enter_tile();
    void finish_tile();
    bool draws_right_only() const;
    bool counts_samples() const;
    bool shows_at_once() const;

    Execution& execution_;
    GeometryCommands& geometry_;
    OpenBlock& block_;
    unsigned first_slot_ = 0;  // of the block's tiles: in one of them primitives are counted
    bool for_right_eye_ = false;
    bool for_others_ = false;  ///< it draws what other nodes show
};

}  // namespace wall::tileserver
