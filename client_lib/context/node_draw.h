// SPDX-License-Identifier: MIT
// Draws from buffers that the nodes keep: what travels is the draw, not its vertices (DESIGN, section 4, "Vertex data
// stays on the nodes"). The context's thread.
#pragma once

#include <cstddef>
#include <optional>

#include "client_lib/context/client_arrays.h"
#include "client_lib/context/context.h"
#include "client_lib/objects/vertex_input.h"

namespace wall::client {

/// The arguments of a draw as the program gave them.
struct ArrayDraw {
    GLenum mode = GL_POINTS;
    GLint first = 0;  ///< without indices
    GLsizei count = 0;
    GLenum index_type = 0;          ///< 0: no indices
    const void* indices = nullptr;  ///< or an offset into the buffer of indices
    GLint base_vertex = 0;          ///< is added to indices
    std::optional<GLuint> restart;  ///< an index at which the primitive begins anew
    GLsizei instances = 1;
    GLuint base_instance = 0;  ///< the first one; of draw() only (api/array_draws.h)
};

/// Its elements, of one instance. The indices stay while `reading` does; there are fewer where their buffer ends.
ElementRange elements_of(Context& c, const ArrayDraw& draw, GLsizei instance, BufferReading& reading);

/// False: nothing was done, and the draw must be made from the arrays as they are in memory (draw_elements), because
/// they do not lie in buffers, change as often as they are drawn, reach beyond their buffers, or because a display list
/// is being compiled.
bool draw_on_nodes(Context& c, const ArrayDraw& draw);
/// The same with an input that names the arrays; the indices are where the context has them.
bool draw_if_worth(Context& c, VertexInput& input, const ArrayDraw& draw);
/// Draws on nodes from an input that was made for this draw: all elements lie in its buffers, and the indices, if there
/// are any, in memory.
void draw_from(Context& c, VertexInput& input, const ArrayDraw& draw);
/// The most bytes of indices that can come along with a draw.
inline constexpr std::size_t kLargestIndices = std::size_t{64} << 20;

}  // namespace wall::client
