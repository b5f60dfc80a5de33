// SPDX-License-Identifier: MIT
// The box around the vertices that a draw takes from its arrays, and the highest element among them (DESIGN, section 4:
// a cached box for each range). Any thread; the arrays must stay meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "client_lib/context/client_arrays.h"
#include "common/geom/box.h"
#include "common/glstate/pieces.h"

namespace wall::client {

struct ElementBounds {
    geom::Box box;
    std::uint32_t first = 0, last = 0;      ///< the lowest and the highest element
    std::vector<glstate::PieceBox> pieces;  ///< empty: not cut, or one of them has no bounds
};

/// `elements` has at least one.
ElementBounds bounds_of(const ArraySource& positions, const ElementRange& elements,
                        const std::optional<glstate::Cut>& cut);

}  // namespace wall::client
