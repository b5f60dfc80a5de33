// SPDX-License-Identifier: MIT
// Whether draws may be dealt to nodes that each draw a part: their order cannot matter, and they are composed by depth,
// or they blend, and are composed in the order that the program makes (A3.3; docs/sort-last.md). Pure.
#pragma once

#include <optional>

#include "gen/glstate/state.gen.h"

namespace wall::client {

/// How what is drawn with this state can be composed (PartialMerge); nothing: it cannot. By a depth function, where
/// what is left of a pixel is what lies nearest, whole and by itself. Or by GL_BLEND, where all that is drawn in turn
/// leaves of what was there before is a share; of a window with alpha bits (`has_alpha`), also of its alpha.
std::optional<std::uint32_t> composed_by(const glstate::State& state, bool has_alpha);

/// The state with which a node draws for others: as the program's, and the stencil value of each pixel that is drawn
/// becomes 1. Where it blends, the pixel's alpha becomes what it leaves of what lies behind, as 1 - alpha. `state`
/// itself has it during a scope, under ids that stay the same as long as the program's own do.
class MarkingState {
public:
    /// The ids that go together; whoever deals keeps it from draw to draw.
    struct Ids {
        struct Pair {
            std::uint64_t own = 0, marking = 0;
        };
        Pair depth_stencil, color_buffer;
    };
    /// `by`: as composed_by() says.
    MarkingState(glstate::State& state, std::uint32_t by, Ids& ids);
    ~MarkingState();
    MarkingState(const MarkingState&) = delete;
    MarkingState& operator=(const MarkingState&) = delete;

private:
    void mark();
    void keep_shares();
    void rename(glstate::Category category, Ids::Pair& ids);
    void restore(glstate::Category category, const Ids::Pair& ids);

    glstate::State& state_;
    const glstate::DepthStencilState own_;
    const glstate::BlendFunc own_func_;
    const glstate::BlendEquation own_equation_;
    const std::uint32_t by_;
    Ids& ids_;
};

}  // namespace wall::client
