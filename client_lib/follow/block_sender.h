// SPDX-License-Identifier: MIT
// Sends one block of geometry to the nodes that need it. A block that lies on one node goes there whole. A block over
// several nodes is taken apart: first by primitives (glBegin .. glEnd), and a large primitive by its own triangles, so
// that each node gets only what can touch its tiles (W3.2 sorts whole buffers by one box; a mesh in one glBegin would
// then be sent to all). What a piece needs from before it (current attributes, the strip's last vertices) is packed in
// front of it. The session's mutex is held.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/followers.h"
#include "client_lib/follow/ideal.h"
#include "client_lib/geometry/primitive_scan.h"
#include "client_lib/geometry/sight.h"

namespace wall::client {

/// Current attributes that a block begins with on a node that lacks them. They are what programs leave set from block
/// to block, and as commands of geometry shorter than as values of state.
class LeadingAttributes {
public:
    static constexpr std::array kKinds{Attribute::color, Attribute::normal, Attribute::texcoord};
    void add(Attribute attribute) { bits_ |= 1u << static_cast<unsigned>(attribute); }
    bool has(Attribute attribute) const { return bits_ >> static_cast<unsigned>(attribute) & 1; }

private:
    std::uint32_t bits_ = 0;
};

/// One node's share of a block that is taken apart.
struct NodeShare {
    Node* node = nullptr;
    wire::PackBuffer* buffer = nullptr;
    std::uint64_t mask = 0;  ///< of the open Block; 0: none is open
    OpenBlock block;
    LeadingAttributes leading;                   ///< that its first Block is to begin with
    AttributePlaces sent;                        ///< what the node got of this block's attributes
    std::int64_t run_first = -1, run_last = -1;  ///< pending run of vertices of the primitive being divided
    std::uint64_t run_mask = 0;
};

/// Commands of a block in a node's batch.
struct PackedPart {
    NodeIndex node;
    std::uint64_t batch = 0;  ///< Node::batches
    wire::PackMark first, last;
};

/// What sorting writes into, kept by whoever sends blocks from block to block, so that no triangle asks for memory.
/// Guarded by the session's mutex.
struct SortScratch {
    std::vector<NodeShare> shares;              ///< by node
    NodeMasks touched;                          ///< by a primitive
    NodeMasks touched_part;                     ///< by a triangle of it
    std::vector<TargetLayer> candidates;        ///< that a primitive's triangles may touch
    VertexScan vertices;                        ///< of the primitive being divided
    Sight sight;                                ///< of the block
    IdealTraffic ideal;                         ///< unused without WALLGL_IDEAL
    std::vector<PackedPart>* packed = nullptr;  ///< if somebody wants to know where they went
};

class BlockSender {
public:
    /// All of them outlive it.
    BlockSender(const Followers& followers, const DrawSource& source, const Packer& packer,
                const glstate::Projection& projection, SortScratch& scratch)
        : followers_(followers), source_(source), packer_(packer), projection_(projection), scratch_(scratch) {}

    /// Sends the block and leaves the context's state and all mirrors as they are after it.
    void run();

private:
    using Share = NodeShare;
    /// The block as one Block for these layers.
    void pack_whole(wire::PackBuffer& buffer, std::uint64_t slots) const;
    void send_whole(const NodeMasks& nodes);
    void send_dealt(const Dealer::Dealt& dealt, const NodeMasks& nodes);
    /// What send_whole() and send_dealt() do on one node.
    void send_to(Node& node, std::uint64_t slots, bool dealt);
    void send_apart();
    void send_primitive(const Primitive& primitive, BlockWalk& walk);
    bool may_be_divided(const Primitive& primitive) const;
    void divide(const Primitive& primitive, const AttributePlaces& before, const Reach& reach);
    void add_to_run(Share& share, const Primitive& primitive, std::int64_t first, std::int64_t last,
                    std::uint64_t mask);
    void finish_run(Share& share, const Primitive& primitive);

    template <class Seen>
    Share& share_of(NodeIndex node, Seen&& seen);
    LeadingAttributes take_leading(Node& node, Needs& needs) const;
    void pack_leading(Node& node, wire::PackBuffer& buffer, LeadingAttributes leading) const;
    void pack_current(Node& node, wire::PackBuffer& buffer, Attribute attribute) const;
    void open_block(Share& share, std::uint64_t mask);
    void close_block(Share& share);
    void note_packed(const Node& node, wire::PackMark first, wire::PackMark last) const;
    void pack_attributes(Share& share, const AttributePlaces& wanted);
    void restore_attribute(Share& share, Attribute attribute);
    void begin_part(Share& share, const Primitive& primitive);
    void copy(Share& share, wire::PackMark first, wire::PackMark last);

    void fold(const std::vector<Node*>& whole);

    const Followers& followers_;
    const DrawSource& source_;
    const Packer& packer_;
    const glstate::Projection& projection_;
    SortScratch& scratch_;
    KeptFrame* kept_ =
        nullptr;  ///< has the block, too, for the part of the window that no tile shows; null: it has not
    Needs needs_;
};

}  // namespace wall::client
