// SPDX-License-Identifier: MIT
// Draws from buffers that the nodes keep: what travels is the draw, not its vertices (DESIGN, section 4, "Vertex data
// stays on the nodes"). The context's thread.
#pragma once

#include "client_lib/context/client_arrays.h"
#include "client_lib/context/context.h"

namespace wall::client {

/// The arguments of a draw as the program gave them.
struct ArrayDraw {
    GLenum mode = GL_POINTS;
    GLint first = 0;  ///< without indices
    GLsizei count = 0;
    GLenum index_type = 0;          ///< 0: no indices
    const void* indices = nullptr;  ///< or an offset into the buffer of indices
};

/// False: nothing was done, and the draw must be made from the arrays as they are in memory (draw_elements), because
/// they do not lie in buffers, change as often as they are drawn, reach beyond their buffers, or because a display list
/// is being compiled.
bool draw_on_nodes(Context& c, const ArrayDraw& draw);

}  // namespace wall::client
