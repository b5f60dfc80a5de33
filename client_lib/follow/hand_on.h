// SPDX-License-Identifier: MIT
// What several nodes lack alike of the objects that a draw needs goes over the program's link once: one of them gets
// it, and hands it on to the next (docs/hand-on.md), as networks broadcast badly (W3.2). The session's mutex is held.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/geometry/target_layers.h"
#include "client_lib/objects/object.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

class HandOn {
public:
    /// From so much on it is a parcel; less is sent to each node: at 1 Gbit/s it takes half a millisecond.
    static constexpr std::size_t kLeastParcel = std::size_t{64} << 10;  // bytes

    /// `nodes` outlives it.
    explicit HandOn(Nodes& nodes) : nodes_(nodes) {}

    /// Before a draw is packed for any of these nodes.
    void bring(const NodeMasks& to, const DrawSource& source);

private:
    void bring(const Object& object);
    /// Those of `able_` that have the object as of the same time, and not as it is: as many as there are.
    std::uint64_t find_lacking(const Object& object);
    /// Leaves in `lacking_` those that do not have it from another program, either (A6).
    void ask(const Object& object);
    void deliver();

    Nodes& nodes_;
    ContextId context_;        // of the draw
    std::vector<Node*> able_;  // to hand on, among those that it goes to
    std::vector<Node*> lacking_;
    wire::PackBuffer packed_;
};

}  // namespace wall::client
