// SPDX-License-Identifier: MIT
// Sends one block of geometry to the nodes that need it. A block that lies on one node goes there whole. A block over
// several nodes is taken apart: first by primitives (glBegin .. glEnd), and a large primitive by its own triangles, so
// that each node gets only what can touch its tiles (W3.2 sorts whole buffers by one box; a mesh in one glBegin would
// then be sent to all). What a piece needs from before it (current attributes, the strip's last vertices) is packed in
// front of it. The session's mutex is held.
#pragma once

#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/geometry/primitive_scan.h"

namespace wall::client {

/// One node's share of a block that is taken apart.
struct NodeShare {
    Node* node = nullptr;
    wire::PackBuffer* buffer = nullptr;
    std::uint64_t mask = 0;          ///< of the open Block; 0: none is open
    std::size_t block_operands = 0;  ///< where the open Block's operands stand
    wire::PackMark block_start;
    AttributePlaces sent;                        ///< what the node got of this block's attributes
    std::int64_t run_first = -1, run_last = -1;  ///< pending run of vertices of the primitive being divided
    std::uint64_t run_mask = 0;
};

/// What sorting writes into, kept by the session from block to block, so that no triangle asks for memory. Guarded by
/// the session's mutex.
struct SortScratch {
    std::vector<NodeShare> shares;   ///< by node
    NodeMasks touched;               ///< by a primitive
    NodeMasks touched_part;          ///< by a triangle of it
    std::vector<Target> candidates;  ///< that a primitive's triangles may touch
    VertexScan vertices;             ///< of the primitive being divided
};

class BlockSender {
public:
    BlockSender(ClientSession& session, Context& context, SortScratch& scratch)
        : session_(session), context_(context), packer_(context.packer), scratch_(scratch) {}

    /// Sends the block and leaves `context.state` and all mirrors as they are after it.
    void run();

private:
    using Share = NodeShare;
    void keep();
    void send_whole(const NodeMasks& nodes);
    void send_apart();
    void send_primitive(const Primitive& primitive, BlockWalk& walk);
    bool may_be_divided(const Primitive& primitive) const;
    void divide(const Primitive& primitive, const AttributePlaces& before, const std::optional<PixelRect>& rect);
    void add_to_run(Share& share, const Primitive& primitive, std::int64_t first, std::int64_t last,
                    std::uint64_t mask);
    void finish_run(Share& share, const Primitive& primitive);

    Share& share_of(NodeIndex node);
    void open_block(Share& share, std::uint64_t mask);
    void close_block(Share& share);
    void pack_attributes(Share& share, const AttributePlaces& wanted);
    void restore_attribute(Share& share, Attribute attribute);
    void begin_part(Share& share, const Primitive& primitive);
    void copy(Share& share, wire::PackMark first, wire::PackMark last);

    void fold(const std::vector<Node*>& whole);

    ClientSession& session_;
    Context& context_;
    Packer& packer_;
    SortScratch& scratch_;
    const SurfaceLayout* layout_ = nullptr;
    Node* kept_ =
        nullptr;  ///< follows the block's copy for the part of the window that no tile shows; null: there is none
    Needs needs_;
};

}  // namespace wall::client
