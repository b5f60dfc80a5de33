// SPDX-License-Identifier: MIT
// Brings nodes up to date with the objects that a context draws with (T3.5). Large content is not sent to a node that
// has it already from another program (A6: global share). The session's mutex is held.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/objects/object.h"

namespace wall::client {

/// A batch of objects is sent when it reaches this, bytes.
inline constexpr std::size_t kObjectBatchBytes = std::size_t{4} << 20;

/// Whether the node can be expected to answer a question about content soon.
inline bool may_be_asked(const Node& node) { return node.answers() && !node.slow && !node.asks_unanswered; }

/// Packs what one node lacks into its batch.
class ObjectSender {
public:
    ObjectSender(Nodes& nodes, Node& node, wire::PackBuffer& buffer)
        : nodes_(nodes), node_(node), buffer_(buffer), start_(buffer.bytes()) {}

    void send(const Object& object);
    /// Of all objects together, also those that are on their way.
    std::size_t bytes() const { return sent_ + buffer_.bytes() - start_; }
    /// Asks a node that may_be_asked() and has nothing of the object. One short round trip, for which the session's
    /// mutex stays taken. True: it has found all of it among what other programs have brought. False: send it; the node
    /// then keeps it for others, too, whether its answer was that or came too late.
    bool held(const Object& object);

private:
    void fetch(const Object& object, bool again);
    /// False: it does not answer.
    bool fetch_from(Node& holder, const Object& object);
    /// What was read back from the nodes of a wall that the program has left.
    bool send_kept(const Object& object);
    void send_off();

    Nodes& nodes_;
    Node& node_;
    wire::PackBuffer& buffer_;
    std::size_t start_;     // of what is still in the buffer
    std::size_t sent_ = 0;  // is not in the buffer any more
};

/// Before a command is packed for any node: those that it goes to, and have not what nodes alone have of the objects
/// that it needs (Object::is_drawn), get that from one that has it. A node that it would go to but is left out of
/// frames has it no more.
void bring_drawn(Nodes& nodes, const DrawSource& source);

/// Packs of all objects that drawing with the context, whose mirror it is, needs what the node lacks. Returns the
/// bytes; full batches among them have been sent.
std::size_t bring_up_to_date(Nodes& nodes, Node& node, Mirror& mirror, const DrawSource& source,
                             wire::PackBuffer& buffer);

/// Reads back what only nodes have, of all objects of the process, before the program leaves their wall
/// (kept_content.h).
void keep_drawn(Nodes& nodes);

/// For a block that is kept: notes in `follower.object_stamps` what drawing with the context uses, and packs the values
/// that go with the block.
void note_used(Node& follower, Mirror& mirror, const DrawSource& source, wire::PackBuffer& buffer);

/// Packs of the noted objects what the node lacks; none of them has changed since. Values that go with blocks follow.
void bring_noted(Nodes& nodes, Node& node, ShareGroup& share, const ObjectStamps& noted, wire::PackBuffer& buffer);

}  // namespace wall::client
