// SPDX-License-Identifier: MIT
// The objects that a single draw names: vertex inputs with their buffers, runs of lists. What drawing with a context
// needs whatever is drawn are UsedObjects. The session's mutex is held.
#pragma once

#include <mutex>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/object_sender.h"

namespace wall::client {

/// What draw_on() asks of them; here of a draw that names none.
struct NamesNone {
    /// Whether the node is known to have all of them as they are. False: they themselves tell.
    bool are_on(const Node&) const { return true; }
    /// Calls `use` with each, in an order in which a node can get them. The share group's mutex is held.
    template <class Use>
    void for_each(Use&&) const {}
    /// The node has been brought all of them.
    void note_on(Node&) const {}
    /// The draw is packed for the node, or kept for a later one that follows as this does.
    void note_drawn(Node&) const {}
};

/// Packs what the node lacks of them.
template <class Named>
void bring_named(Nodes& nodes, Node& node, const DrawSource& source, const Named& named, wire::PackBuffer& buffer) {
    if (named.are_on(node)) return;
    std::lock_guard lock(source.share->mutex);
    ObjectSender sender(nodes, node, buffer);
    named.for_each([&](const Object& object) { sender.send(object); });
    if (node.hollow.empty()) named.note_on(node);
    count(node, NodeCounter::object_bytes, sender.bytes());
}

/// For a draw that is kept: notes them in `follower.object_stamps`.
template <class Named>
void note_named(Node& follower, const DrawSource& source, const Named& named) {
    if (named.are_on(follower)) return;
    std::lock_guard lock(source.share->mutex);
    named.for_each([&](const Object& object) { follower.object_stamps[object.id] = object.latest(); });
    named.note_on(follower);
}

}  // namespace wall::client
