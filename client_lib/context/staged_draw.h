// SPDX-License-Identifier: MIT
// Instanced draws whose arrays the nodes do not have: arrays in the program's memory, or that reach beyond their
// buffers. Vertices in a block know no instances (gl_InstanceIDARB), so what the draw reads is put into buffers that
// the context has for this, and drawn from them. The context's thread.
#pragma once

#include "client_lib/context/node_draw.h"

namespace wall::client {

/// Draws at once (not into a display list) on the nodes, whatever the arrays are.
void draw_staged(Context& c, const ArrayDraw& draw);

}  // namespace wall::client
