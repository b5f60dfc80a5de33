// SPDX-License-Identifier: MIT
// What a block of geometry leaves behind in a state: its last attributes and materials (T3.2 keeps them in the block
// until somebody needs them). Pure.
#pragma once

#include "client_lib/geometry/packer.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// The state of the context that the block is of becomes what it is behind it.
void fold_block(const Packer& packer, glstate::State& state);
/// The same for the mirror of a node that ran all of the block. `folded` is the context's state behind it, and lends
/// its value ids where the values are the same.
void fold_block(const Packer& packer, glstate::State& mirror, const glstate::State& folded);

}  // namespace wall::client
