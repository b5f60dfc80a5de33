// SPDX-License-Identifier: MIT
// Draws from arrays in the program's memory, of which the nodes have copies (array_copies.h). The context's thread.
#pragma once

#include "client_lib/context/node_draw.h"

namespace wall::client {

/// Draws on the nodes with arrays that lie in the program's memory, all or some of them, from copies. False: nothing
/// was done, because it is small, or they change with every draw, or the memory in between is not the draw's.
bool draw_copied(Context& c, const ArrayDraw& draw);

}  // namespace wall::client
