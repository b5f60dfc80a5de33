// SPDX-License-Identifier: MIT
// Whether the order of draws cannot matter, so that they may be dealt to nodes that each draw a part, and be composed
// by depth (A3.3; docs/sort-last.md). Pure.
#pragma once

#include <optional>

#include "gen/glstate/state.gen.h"

namespace wall::client {

/// The depth function by which what is drawn with this state can be composed; nothing: it is not for that. What is left
/// of a pixel must be what lies nearest, whole and by itself.
std::optional<std::uint32_t> composed_by(const glstate::State& state);

/// The state of depth and stencil with which a node draws for others: as the program's, and the stencil value of each
/// pixel that is drawn becomes 1. `state` itself has it during a scope, under an id that stays the same as long as the
/// program's own does.
class MarkingState {
public:
    /// The ids that go together; whoever deals keeps it from draw to draw.
    struct Ids {
        std::uint64_t own = 0, marking = 0;
    };
    MarkingState(glstate::State& state, Ids& ids);
    ~MarkingState();
    MarkingState(const MarkingState&) = delete;
    MarkingState& operator=(const MarkingState&) = delete;

private:
    glstate::State& state_;
    const glstate::DepthStencilState own_;
    const std::uint64_t named_;
};

}  // namespace wall::client
