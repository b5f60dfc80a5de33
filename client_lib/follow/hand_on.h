// SPDX-License-Identifier: MIT
// What several nodes lack alike of the objects that a draw needs goes over the program's link once: one of them gets
// it, and hands it on to the next (docs/hand-on.md), as networks broadcast badly (W3.2). The session's mutex is held.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/named_objects.h"
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

    /// Before a draw is packed for any of these nodes: what drawing with the context needs.
    void bring_used(const NodeMasks& to, const DrawSource& source);
    /// The same of what the draw names.
    template <class Named>
    void bring_named(const NodeMasks& to, const DrawSource& source, const Named& named) {
        if (!find_able(to, source, [&](const Node& node) { return !named.are_on(node); })) return;
        std::lock_guard lock(source.share->mutex);
        named.for_each([&](const Object& object) { bring(object); });
    }

private:
    /// Those that may lack something. Whether there are two, and they hand on.
    template <class MayLack>
    bool find_able(const NodeMasks& to, const DrawSource& source, MayLack&& may_lack) {
        able_.clear();
        context_ = source.id;
        if (to.size() < 2) return false;
        for (const auto& [index, slots] : to) {
            Node& node = nodes_[index];
            if (nodes_.may_hand_on(node) && source.draw.goes_to(node) && may_lack(node)) able_.push_back(&node);
        }
        return able_.size() >= 2 && nodes_.hand_on();
    }
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
