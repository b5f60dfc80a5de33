// SPDX-License-Identifier: MIT
#include "client_lib/follow/block_sender.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "client_lib/follow/hidden_part.h"
#include "client_lib/geometry/fold.h"
#include "client_lib/process/options.h"
#include "common/glstate/draw_buffers.h"

namespace wall::client {
namespace {

using glstate::Category;

/// A primitive smaller than this costs less sent whole to one node more than taken apart.
constexpr std::size_t kSmallPrimitiveBytes = 192;
/// Vertices between two runs of one strip that cost no more than ending it and starting anew.
constexpr std::int64_t kGapVertices = 2;

bool same_attribute(const glstate::State& a, const glstate::State& b, Attribute attribute) {
    std::array<std::byte, glstate::kMostAttributeBytes> of_a, of_b;
    const glapi::Op op = glstate::write_attribute(a, attribute, of_a.data());
    return op == glstate::write_attribute(b, attribute, of_b.data()) &&
           std::memcmp(of_a.data(), of_b.data(), operand_bytes_of(op)) == 0;
}

}  // namespace

void BlockSender::run() {
    if (!packer_.has_geometry() || !source_.draw) return fold({});
    if (source_.draw.layers().empty() && !source_.draw.with_hidden_part()) return fold({});
    before_drawing(followers_, source_);
    const bool everywhere =
        options().broadcast || glstate::counts_primitives(source_.state) || source_.objects.writes();
    source_.draw.note_camera(projection_, &packer_.block_box());
    scratch_.sight.aim(projection_, source_.draw.views());
    const Reach box = everywhere ? Reach() : scratch_.sight.of(packer_.block_box());
    kept_ = followers_.hidden.begin_keeping(source_, box.window);
    if (options().count_ideal) scratch_.ideal.count(source_, packer_, projection_);
    needs_ = needs_of_block(source_.state, packer_);
    if (kept_) pack_whole(followers_.hidden.prepare(*kept_, source_, needs_), kept_->layer.bit());
    NodeMasks& nodes = scratch_.touched;
    nodes_touched(source_.draw.layers(), box, nodes);
    const auto commands = static_cast<double>(packer_.commands());
    if (const auto dealt =
            everywhere ? std::span<const Dealer::Dealt>() : followers_.dealer.deal(source_, box, commands);
        !dealt.empty()) {
        send_dealt(dealt.front(), nodes);
        return note_content(source_);
    }
    followers_.dealer.compose(source_.draw);
    followers_.updater.prepare_all(nodes, source_);
    const bool single = packer_.primitives().size() == 1 && !may_be_divided(packer_.primitives()[0]);
    const bool whole = packer_.has_rare() || everywhere || single || source_.draw.drawn_alike();
    if (nodes.size() <= 1 || whole) send_whole(nodes);
    else send_apart();
    note_content(source_);
}

void BlockSender::pack_whole(wire::PackBuffer& buffer, std::uint64_t slots) const {
    glapi::pack::Block(buffer, static_cast<std::uint32_t>(slots), static_cast<std::uint32_t>(slots >> 32),
                       static_cast<std::uint32_t>(packer_.commands()),
                       static_cast<std::uint32_t>(packer_.operand_bytes()));
    buffer.append(packer_, {}, packer_.mark());
}

void BlockSender::send_whole(const NodeMasks& nodes) {
    std::vector<Node*> reached;
    for (const auto& [index, slots] : nodes) {
        Node& node = followers_.nodes[index];
        if (!source_.draw.goes_to(node)) continue;
        send_to(node, slots, false);
        reached.push_back(&node);
    }
    fold(reached);
}

/// To one node, and to those that record.
void BlockSender::send_dealt(const Dealer::Dealt& dealt, const NodeMasks& nodes) {
    std::vector<Node*> reached;
    if (dealt.mask != 0 && dealt.node->alive()) {
        send_to(*dealt.node, dealt.mask, true);
        reached.push_back(dealt.node);
    }
    for (const auto& [index, slots] : nodes) {
        Node& node = followers_.nodes[index];
        if (!node.records() || !source_.draw.goes_to(node)) continue;
        send_to(node, slots, false);
        reached.push_back(&node);
    }
    fold(reached);
}

void BlockSender::send_to(Node& node, std::uint64_t slots, bool dealt) {
    Needs needs = needs_;
    const LeadingAttributes leading = take_leading(node, needs);
    auto& buffer =
        dealt ? followers_.dealer.prepare(node, source_, needs) : followers_.updater.prepare(node, source_, needs);
    const std::size_t before = buffer.bytes();
    const auto block = begin_block(buffer, slots);
    pack_leading(node, buffer, leading);
    buffer.append(packer_, {}, packer_.mark());
    end_block(buffer, block);
    note_packed(node, block.start, buffer.mark());
    count(node, NodeCounter::geometry_bytes, buffer.bytes() - before);
    count(node, NodeCounter::blocks, 1);
}

/// `seen()`: the attributes that the first piece of a share sees. What the block has set by then is packed with it, and
/// need not be current on the node before.
template <class Seen>
BlockSender::Share& BlockSender::share_of(NodeIndex index, Seen&& seen) {
    Share& share = scratch_.shares[index.value];
    if (share.node) return share;
    share.node = &followers_.nodes[index];
    if (!source_.draw.goes_to(*share.node)) return share;
    Needs needs = needs_;
    const AttributePlaces& places = seen();
    for (std::size_t i = 0; i < kAttributes; ++i)
        if (places.offset[i] != AttributePlaces::kNone) needs.spare(static_cast<Attribute>(i));
    share.leading = take_leading(*share.node, needs);
    share.buffer = &followers_.updater.prepare(*share.node, source_, needs);
    return share;
}

/// Those that the node lacks, out of `needs`.
LeadingAttributes BlockSender::take_leading(Node& node, Needs& needs) const {
    LeadingAttributes leading;
    const glstate::State& mirror = node.mirrors[source_.id].state;
    constexpr auto kCurrent = static_cast<std::size_t>(Category::current);
    if (mirror.ids[kCurrent] == source_.state.ids[kCurrent]) return leading;
    for (const Attribute attribute : LeadingAttributes::kKinds) {
        if (needs.waits(attribute) || same_attribute(mirror, source_.state, attribute)) continue;
        leading.add(attribute);
        needs.spare(attribute);
    }
    return leading;
}

void BlockSender::pack_leading(Node& node, wire::PackBuffer& buffer, LeadingAttributes leading) const {
    for (const Attribute attribute : LeadingAttributes::kKinds)
        if (leading.has(attribute)) pack_current(node, buffer, attribute);
}

/// As the context has it, for the node to have it, too.
void BlockSender::pack_current(Node& node, wire::PackBuffer& buffer, Attribute attribute) const {
    std::array<std::byte, glstate::kMostAttributeBytes> operand;
    const glapi::Op op = glstate::write_attribute(source_.state, attribute, operand.data());
    const std::size_t bytes = operand_bytes_of(op);
    std::memcpy(buffer.append(static_cast<std::uint8_t>(op), bytes), operand.data(), bytes);
    glstate::apply_attribute(node.mirrors[source_.id].state, op, operand.data());
}

void BlockSender::send_apart() {
    scratch_.shares.assign(followers_.nodes.size(), Share{});
    BlockWalk walk(packer_, {}, packer_.mark(), {});
    for (const Primitive& primitive : packer_.primitives()) {
        const Reach reach = scratch_.sight.of(primitive.box, primitive.mode);
        nodes_touched(source_.draw.layers(), reach, scratch_.touched);
        if (scratch_.touched.empty()) continue;
        walk.go_to(primitive.first);
        if (scratch_.touched.size() > 1 && may_be_divided(primitive)) divide(primitive, walk.places(), reach);
        else send_primitive(primitive, walk);
    }
    for (Share& share : scratch_.shares) close_block(share);

    // Nodes that got a part hold the attributes of their own last piece; the next diff brings the rest.
    for (Share& share : scratch_.shares) {
        if (!share.buffer) continue;
        auto& mirror = share.node->mirrors[source_.id].state;
        bool changed = false;
        for (std::size_t i = 0; i < kAttributes; ++i) {
            if (share.sent.offset[i] == AttributePlaces::kNone) continue;
            glstate::apply_attribute(mirror, share.sent.op[i], packer_.operand_at(share.sent.offset[i]));
            changed = true;
        }
        if (changed) mirror.ids.renew(static_cast<std::size_t>(Category::current));
    }
    fold({});
}

/// `walk` goes over the primitive.
void BlockSender::send_primitive(const Primitive& primitive, BlockWalk& walk) {
    for (const auto& [index, slots] : scratch_.touched) {
        Share& share = share_of(index, [&]() -> const AttributePlaces& { return walk.places(); });
        if (!share.buffer) continue;
        open_block(share, slots);
        pack_attributes(share, walk.places());
        copy(share, primitive.first, primitive.last);
    }
    walk.go_to(primitive.last);
    for (const auto& [index, slots] : scratch_.touched)
        if (Share& share = scratch_.shares[index.value]; share.buffer) share.sent = walk.places();
}

bool BlockSender::may_be_divided(const Primitive& primitive) const {
    if (!primitive.divisible || !topology_of(primitive.mode)) return false;
    if (primitive.last.operand_bytes - primitive.first.operand_bytes < kSmallPrimitiveBytes) return false;
    if (primitive.box.unbounded()) return false;
    return !source_.state.line_point.line_stipple_enabled;  // its counter runs along the primitive
}

/// `reach`: of the whole primitive.
void BlockSender::divide(const Primitive& primitive, const AttributePlaces& before, const Reach& reach) {
    const Topology topology = *topology_of(primitive.mode);
    VertexScan& vertices = scratch_.vertices;
    vertices.scan(packer_, primitive, before, projection_);
    scratch_.candidates.clear();
    for (const TargetLayer& layer : source_.draw.layers())
        if (reach.touches(layer)) scratch_.candidates.push_back(layer);
    for (std::size_t v = topology.fan ? 1 : 0; v + topology.size <= vertices.size(); v += topology.step) {
        nodes_touched(scratch_.candidates, scratch_.sight.of(topology, vertices, v), scratch_.touched_part);
        const auto first = static_cast<std::int64_t>(v / topology.alignment * topology.alignment),
                   last = static_cast<std::int64_t>(v + topology.size - 1);
        const auto seen = [&] { return vertices.attributes(topology.fan ? 0 : static_cast<std::size_t>(first)); };
        for (const auto& [index, slots] : scratch_.touched_part)
            if (Share& share = share_of(index, seen); share.buffer) add_to_run(share, primitive, first, last, slots);
    }
    for (Share& share : scratch_.shares)
        if (share.run_first >= 0) finish_run(share, primitive);
}

/// Vertices `first` to `last` make something that the tiles of `mask` need.
void BlockSender::add_to_run(Share& share, const Primitive& primitive, std::int64_t first, std::int64_t last,
                             std::uint64_t mask) {
    const std::int64_t gap = topology_of(primitive.mode)->independent ? 0 : kGapVertices;
    if (share.run_first >= 0 && (first > share.run_last + 1 + gap || share.run_mask != mask))
        finish_run(share, primitive);
    if (share.run_first < 0) share.run_first = first, share.run_mask = mask;
    share.run_last = last;
}

// A run becomes a primitive of its own, with the attributes that its first vertex sees.
void BlockSender::finish_run(Share& share, const Primitive& primitive) {
    const VertexScan& vertices = scratch_.vertices;
    const auto first = static_cast<std::size_t>(share.run_first), behind = static_cast<std::size_t>(share.run_last + 1);
    open_block(share, share.run_mask);
    if (primitive.mode == GL_TRIANGLE_FAN) {
        pack_attributes(share, vertices.attributes(0));
        begin_part(share, primitive);
        copy(share, vertices.lead(0), vertices.lead(1));
        share.sent = vertices.attributes(1);
        pack_attributes(share, vertices.attributes(first));
    } else {
        pack_attributes(share, vertices.attributes(first));
        begin_part(share, primitive);
    }
    copy(share, vertices.lead(first), vertices.lead(behind));
    share.sent = vertices.attributes(behind);
    glapi::pack::End(*share.buffer);
    count(*share.node, NodeCounter::geometry_bytes, 1);
    share.run_first = share.run_last = -1;
}

void BlockSender::begin_part(Share& share, const Primitive& primitive) {
    const std::size_t before = share.buffer->bytes();
    glapi::pack::Begin(*share.buffer, primitive.mode);
    count(*share.node, NodeCounter::geometry_bytes, share.buffer->bytes() - before);
}

void BlockSender::open_block(Share& share, std::uint64_t mask) {
    if (share.mask == mask) return;
    close_block(share);
    const std::size_t before = share.buffer->bytes();
    share.block = begin_block(*share.buffer, mask);
    pack_leading(*share.node, *share.buffer, std::exchange(share.leading, {}));
    count(*share.node, NodeCounter::geometry_bytes, share.buffer->bytes() - before);
    count(*share.node, NodeCounter::blocks, 1);
    share.mask = mask;
}

void BlockSender::close_block(Share& share) {
    if (share.mask == 0) return;
    end_block(*share.buffer, share.block);
    note_packed(*share.node, share.block.start, share.buffer->mark());
    share.mask = 0;
}

void BlockSender::note_packed(const Node& node, wire::PackMark first, wire::PackMark last) const {
    if (scratch_.packed != nullptr) scratch_.packed->push_back({node.index, node.batches, first, last});
}

void BlockSender::pack_attributes(Share& share, const AttributePlaces& wanted) {
    if (wanted.offset == share.sent.offset) return;
    for (std::size_t i = 0; i < kAttributes; ++i) {
        if (wanted.offset[i] == share.sent.offset[i]) continue;
        if (wanted.offset[i] == AttributePlaces::kNone) {
            restore_attribute(share, static_cast<Attribute>(i));
            continue;
        }
        const std::size_t bytes = operand_bytes_of(wanted.op[i]);
        std::memcpy(share.buffer->append(static_cast<std::uint8_t>(wanted.op[i]), bytes),
                    packer_.operand_at(wanted.offset[i]), bytes);
        count(*share.node, NodeCounter::geometry_bytes, bytes + 1);
        share.sent.offset[i] = wanted.offset[i];
        share.sent.op[i] = wanted.op[i];
    }
}

// A fan's hub, repeated for a later run, sees the attributes of before the block.
void BlockSender::restore_attribute(Share& share, Attribute attribute) {
    const std::size_t before = share.buffer->bytes();
    pack_current(*share.node, *share.buffer, attribute);
    count(*share.node, NodeCounter::geometry_bytes, share.buffer->bytes() - before);
    share.sent.offset[place_of(attribute)] = AttributePlaces::kNone;
}

void BlockSender::copy(Share& share, wire::PackMark first, wire::PackMark last) {
    share.buffer->append(packer_, first, last);
    count(*share.node, NodeCounter::geometry_bytes,
          last.commands - first.commands + last.operand_bytes - first.operand_bytes);
}

// The block's last attributes become the context's current ones, and those of every node that ran all of it.
void BlockSender::fold(const std::vector<Node*>& whole) {
    fold_block(packer_, source_.state);
    const auto follow = [&](Node& node) { fold_block(packer_, node.mirrors[source_.id].state, source_.state); };
    for (Node* node : whole) follow(*node);
    if (kept_) follow(kept_->follower);
}

}  // namespace wall::client
