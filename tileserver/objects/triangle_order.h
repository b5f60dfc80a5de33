// SPDX-License-Identifier: MIT
// The order in which triangles of a mesh are drawn, so that a vertex that was processed is used again while the GPU
// still has it (O4, "re-order the individual vertices and triangles of the mesh"). Pure. Any thread.
#pragma once

#include <cstdint>
#include <span>

namespace wall::tileserver {

/// Brings the triangles of each `step` indices in a row, multiples of 3, into a better order, where there is one by at
/// least a fiftieth; what is left behind the last triangle stays. Each keeps its three indices in their order, so that
/// the vertex that provokes is the same. True: some have another place now. 5 to 20 million indices a second.
bool order_triangles(std::span<std::uint32_t> indices, std::size_t step);

}  // namespace wall::tileserver
