// SPDX-License-Identifier: MIT
// Group [array_draw]: draws from buffers, in a block. Of a large one only those pieces are drawn that may touch the
// tile (common/glstate/pieces.h). Render thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/glstate/projection.h"
#include "tileserver/execute/execution.h"
#include "tileserver/objects/index_orders.h"
#include "tileserver/objects/vertex_input.h"

namespace wall::tileserver {

class ArrayDrawCommands {
public:
    /// Both outlive it.
    ArrayDrawCommands(Execution& execution, OpenBlock& block) : execution_(execution), block_(block) {}

    void DrawArrays(ClientName input, ClientName pieces, GLenum mode, std::int32_t first, std::int32_t count);
    void DrawElements(ClientName input, ClientName pieces, GLenum mode, std::int32_t count, GLenum type,
                      std::uint32_t offset, std::int32_t base_vertex);
    void DrawIndices(ClientName input, GLenum mode, GLenum type, std::int32_t base_vertex,
                     std::span<const std::byte> indices);

    /// For draws of all kinds: the checks that they have in common. The driver's vertex array object is bound. Null:
    /// nothing is to be drawn, perhaps because it was refused.
    VertexInput* begin(ClientName input, GLenum mode, std::int32_t count);
    /// Whether elements in a row lie in the input's buffers. False: refused, or not to be drawn.
    bool has_elements(VertexInput& input, std::int32_t first, std::int32_t count);
    /// Whether the indices lie in the input's buffer. False: refused, or not to be drawn.
    bool has_indices(VertexInput& input, std::int32_t count, GLenum type, std::uint32_t offset);
    /// How many indices there are in memory; nothing: refused.
    std::optional<std::int32_t> count_indices(GLenum type, std::span<const std::byte> indices);
    /// The driver is given so many.
    void count_elements(std::uint64_t elements) { execution_.session.work.array_elements += elements; }

private:
    void count_runs();
    /// Elements of the draw, in runs, that the tile may show, into `firsts_` and `counts_`.
    void find_runs(ClientName pieces, std::int32_t count, GLenum mode);
    /// Whether all that counts is what a tile shows.
    bool may_be_cut(GLenum mode) const;
    /// Whether nobody sees in which order the triangles of a draw with the state come.
    bool draws_in_any_order(GLenum mode) const;
    /// The driver's buffer in which the indices of the runs lie from its beginning on, in an order that is drawn
    /// faster; 0: none.
    GLuint in_order(const VertexInput& input, ClientName pieces, const IndexRange& all) const;
    /// Where vertices go; nothing: a shader puts them anywhere.
    std::optional<glstate::Projection> projection() const;

    Execution& execution_;
    OpenBlock& block_;
    std::vector<GLint> firsts_;
    std::vector<GLsizei> counts_;
    std::vector<const void*> places_;  // of the indices
    std::vector<GLint> base_vertices_;
};

}  // namespace wall::tileserver
