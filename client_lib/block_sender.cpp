// SPDX-License-Identifier: MIT
#include "client_lib/block_sender.h"

#include <algorithm>
#include <cmath>

#include "client_lib/block_walk.h"
#include "client_lib/options.h"

namespace wall::client {
namespace {

using glstate::Category;

template <Category kCategory>
std::uint64_t& value_id(glstate::State& state) {
    return state.ids[static_cast<std::size_t>(kCategory)];
}

/// A primitive smaller than this costs less sent whole to one node more than taken apart.
constexpr std::size_t kSmallPrimitiveBytes = 192;
/// Vertices between two runs of one strip that cost no more than ending it and starting anew.
constexpr std::int64_t kGapVertices = 2;

}  // namespace

void BlockSender::run() {
    if (context_.draw_surface()) layout_ = &context_.draw_layout();
    if (!packer_.has_geometry() || !layout_ || layout_->targets.empty()) return fold({});
    const auto box = options().broadcast ? std::nullopt : project(context_.projection(), packer_.block_box());
    const TargetSet targets = targets_of(*layout_, box);
    if (options().count_ideal) session_.ideal_.count(context_, *layout_);
    needs_ = needs_of_block(context_.state, packer_);
    const auto nodes = by_node(targets, *layout_);
    const bool single = packer_.primitives().size() == 1 && !worth_dividing(packer_.primitives()[0], targets);
    if (nodes.size() <= 1 || packer_.has_rare() || options().broadcast || single) send_whole(targets);
    else send_apart(targets);
}

void BlockSender::send_whole(const TargetSet& targets) {
    std::vector<Node*> reached;
    for (const auto& [index, slots] : by_node(targets, *layout_)) {
        Node& node = *session_.nodes()[index];
        if (!node.takes(context_.draw_surface()->id)) continue;
        auto& buffer = session_.prepare(node, context_, needs_);
        const std::size_t before = buffer.bytes();
        glapi::pack::Block(buffer, static_cast<std::uint32_t>(slots), static_cast<std::uint32_t>(slots >> 32),
                           static_cast<std::uint32_t>(packer_.commands()),
                           static_cast<std::uint32_t>(packer_.operand_bytes()));
        buffer.append(packer_, {}, packer_.mark());
        session_.count_geometry(node, buffer.bytes() - before);
        session_.count_block(node);
        reached.push_back(&node);
    }
    fold(reached);
}

void BlockSender::send_apart(const TargetSet& block_targets) {
    shares_.resize(session_.nodes().size());
    for (const Primitive& primitive : packer_.primitives()) {
        const auto box = project(context_.projection(), primitive.box);
        const TargetSet targets = targets_of(*layout_, box) & block_targets;
        if (targets.none()) continue;
        if (worth_dividing(primitive, targets)) divide(primitive, targets);
        else send_primitive(primitive, targets);
    }
    for (Share& share : shares_) close_block(share);

    // Nodes that got a part hold the attributes of their own last piece; the next diff brings the rest.
    for (Share& share : shares_) {
        if (!share.buffer) continue;
        auto& mirror = share.node->mirrors[context_.id].state;
        bool changed = false;
        for (std::size_t i = 0; i < kAttributes; ++i) {
            if (share.sent.offset[i] == AttributePlaces::kNone) continue;
            apply_attribute(mirror, share.sent.op[i], packer_.operand_at(share.sent.offset[i]));
            changed = true;
        }
        if (changed) value_id<Category::current>(mirror) = glstate::next_value_id();
    }
    fold({});
}

void BlockSender::send_primitive(const Primitive& primitive, const TargetSet& targets) {
    for (const auto& [index, slots] : by_node(targets, *layout_)) {
        Share& share = share_of(index);
        if (!share.buffer) continue;
        open_block(share, slots);
        pack_attributes(share, primitive.before);
        copy(share, primitive.first, primitive.last);
        share.sent = primitive.after;
    }
}

bool BlockSender::worth_dividing(const Primitive& primitive, const TargetSet& targets) const {
    if (!primitive.divisible || !topology_of(primitive.mode)) return false;
    if (primitive.last.operand_bytes - primitive.first.operand_bytes < kSmallPrimitiveBytes) return false;
    if (primitive.box.unbounded()) return false;
    if (context_.state.line_point.line_stipple_enabled) return false;  // its counter runs along the primitive
    return by_node(targets, *layout_).size() > 1;
}

void BlockSender::divide(const Primitive& primitive, const TargetSet& targets) {
    const Topology topology = *topology_of(primitive.mode);
    vertices_ = scan_vertices(packer_, primitive, context_.projection());
    for (std::size_t v = topology.fan ? 1 : 0; v + topology.size <= vertices_.size(); v += topology.step) {
        const auto rect = window_rect(topology, vertices_, v, context_.projection());
        const TargetSet touched = rect ? targets_of(*layout_, rect) & targets : targets;
        const std::size_t start = v / topology.alignment * topology.alignment;
        for (const auto& [index, slots] : by_node(touched, *layout_)) {
            Share& share = share_of(index);
            if (!share.buffer) continue;
            const auto begin = static_cast<std::int64_t>(start), end = static_cast<std::int64_t>(v + topology.size - 1);
            const std::int64_t gap = topology.independent ? 0 : kGapVertices;
            if (share.run_first >= 0 && (begin > share.run_last + 1 + gap || share.run_mask != slots))
                finish_run(share, primitive);
            if (share.run_first < 0) share.run_first = begin, share.run_mask = slots;
            share.run_last = end;
        }
    }
    for (Share& share : shares_)
        if (share.run_first >= 0) finish_run(share, primitive);
}

// A run becomes a primitive of its own, with the attributes that its first vertex sees.
void BlockSender::finish_run(Share& share, const Primitive& primitive) {
    const PackedVertex& first = vertices_[static_cast<std::size_t>(share.run_first)];
    const PackedVertex& last = vertices_[static_cast<std::size_t>(share.run_last)];
    open_block(share, share.run_mask);
    if (primitive.mode == GL_TRIANGLE_FAN) {
        const PackedVertex& hub = vertices_[0];
        pack_attributes(share, hub.before);
        const std::size_t before = share.buffer->bytes();
        glapi::pack::Begin(*share.buffer, primitive.mode);
        session_.count_geometry(*share.node, share.buffer->bytes() - before);
        copy(share, hub.lead, hub.end);
        share.sent = hub.at;
        pack_attributes(share, first.before);
    } else {
        pack_attributes(share, first.before);
        const std::size_t before = share.buffer->bytes();
        glapi::pack::Begin(*share.buffer, primitive.mode);
        session_.count_geometry(*share.node, share.buffer->bytes() - before);
    }
    copy(share, first.lead, last.end);
    share.sent = last.at;
    glapi::pack::End(*share.buffer);
    session_.count_geometry(*share.node, 1);
    share.run_first = share.run_last = -1;
}

BlockSender::Share& BlockSender::share_of(std::uint32_t index) {
    Share& share = shares_[index];
    if (!share.node) {
        share.node = session_.nodes()[index].get();
        if (share.node->takes(context_.draw_surface()->id))
            share.buffer = &session_.prepare(*share.node, context_, needs_);
    }
    return share;
}

void BlockSender::open_block(Share& share, std::uint64_t mask) {
    if (share.mask == mask) return;
    close_block(share);
    share.block_operands = share.buffer->operand_bytes();
    const std::size_t before = share.buffer->bytes();
    glapi::pack::Block(*share.buffer, static_cast<std::uint32_t>(mask), static_cast<std::uint32_t>(mask >> 32), 0, 0);
    session_.count_geometry(*share.node, share.buffer->bytes() - before);
    session_.count_block(*share.node);
    share.block_start = share.buffer->mark();
    share.mask = mask;
}

void BlockSender::close_block(Share& share) {
    if (share.mask == 0) return;
    const auto end = share.buffer->mark();
    const std::uint32_t counts[2] = {static_cast<std::uint32_t>(end.commands - share.block_start.commands),
                                     static_cast<std::uint32_t>(end.operand_bytes - share.block_start.operand_bytes)};
    std::memcpy(share.buffer->operand_at(share.block_operands + 8), counts, sizeof counts);
    share.mask = 0;
}

void BlockSender::pack_attributes(Share& share, const AttributePlaces& wanted) {
    for (std::size_t i = 0; i < kAttributes; ++i) {
        if (wanted.offset[i] == share.sent.offset[i]) continue;
        if (wanted.offset[i] == AttributePlaces::kNone) {
            restore_attribute(share, static_cast<Attribute>(i));
            continue;
        }
        const std::size_t bytes = operand_bytes_of(wanted.op[i]);
        std::memcpy(share.buffer->append(static_cast<std::uint8_t>(wanted.op[i]), bytes),
                    packer_.operand_at(wanted.offset[i]), bytes);
        session_.count_geometry(*share.node, bytes + 1);
        share.sent.offset[i] = wanted.offset[i];
        share.sent.op[i] = wanted.op[i];
    }
}

// A fan's hub, repeated for a later run, sees the attributes of before the block.
void BlockSender::restore_attribute(Share& share, Attribute attribute) {
    const auto& now = context_.state.current;
    auto& mirror = share.node->mirrors[context_.id].state.current;
    auto& buffer = *share.buffer;
    const std::size_t before = buffer.bytes();
    const auto with4 = [&](auto pack, const auto& v) { pack(buffer, v[0], v[1], v[2], v[3]); };
    const auto with3 = [&](auto pack, const auto& v) { pack(buffer, v[0], v[1], v[2]); };
    switch (attribute) {
        case Attribute::color: with4(glapi::pack::Color4f, mirror.color = now.color); break;
        case Attribute::normal: with3(glapi::pack::Normal3f, mirror.normal = now.normal); break;
        case Attribute::texcoord0: with4(glapi::pack::TexCoord4f, mirror.texcoord[0] = now.texcoord[0]); break;
        case Attribute::secondary_color:
            with3(glapi::pack::SecondaryColor3f, mirror.secondary_color = now.secondary_color);
            break;
        case Attribute::fog_coord: glapi::pack::FogCoordf(buffer, mirror.fog_coord = now.fog_coord); break;
        case Attribute::edge_flag: glapi::pack::EdgeFlag(buffer, mirror.edge_flag = now.edge_flag); break;
        case Attribute::kCount: break;
    }
    session_.count_geometry(*share.node, buffer.bytes() - before);
    share.sent.offset[static_cast<std::size_t>(attribute)] = AttributePlaces::kNone;
}

void BlockSender::copy(Share& share, wire::PackMark first, wire::PackMark last) {
    share.buffer->append(packer_, first, last);
    session_.count_geometry(*share.node, last.commands - first.commands + last.operand_bytes - first.operand_bytes);
}

// The block's last attributes become the context's current ones, and those of every node that ran all of it.
void BlockSender::fold(const std::vector<Node*>& whole) {
    context_.fold_attributes();
    for (Node* node : whole) {
        auto& mirror = node->mirrors[context_.id].state;
        if (packer_.has_rare()) {  // then nothing waited
            mirror.current = context_.state.current;
            if (context_.folded_material()) mirror.material = context_.state.material;
        } else {
            for (std::size_t i = 0; i < kAttributes; ++i)
                if (packer_.last[i]) apply_attribute(mirror, packer_.last_op[i], packer_.last[i]);
        }
        unify_id(mirror, context_.state, Category::current);
        if (context_.folded_material()) unify_id(mirror, context_.state, Category::material);
    }
}

void apply_attribute(glstate::State& state, glapi::Op op, const std::byte* operand) {
    float f[4] = {0, 0, 0, 1};
    const auto floats = [&](std::size_t n) { std::memcpy(f, operand, n * sizeof(float)); };
    using glapi::Op;
    auto& current = state.current;
    switch (op) {
        case Op::Color3f:
            floats(3);
            current.color = {f[0], f[1], f[2], 1};
            break;
        case Op::Color4f:
            floats(4);
            current.color = {f[0], f[1], f[2], f[3]};
            break;
        case Op::Color4ub:
            for (int i = 0; i < 4; ++i) current.color[i] = static_cast<float>(operand[i]) / 255.0f;
            break;
        case Op::Normal3f:
            floats(3);
            current.normal = {f[0], f[1], f[2]};
            break;
        case Op::TexCoord1f:
            floats(1);
            current.texcoord[0] = {f[0], 0, 0, 1};
            break;
        case Op::TexCoord2f:
            floats(2);
            current.texcoord[0] = {f[0], f[1], 0, 1};
            break;
        case Op::TexCoord3f:
            floats(3);
            current.texcoord[0] = {f[0], f[1], f[2], 1};
            break;
        case Op::TexCoord4f:
            floats(4);
            current.texcoord[0] = {f[0], f[1], f[2], f[3]};
            break;
        case Op::SecondaryColor3f:
            floats(3);
            current.secondary_color = {f[0], f[1], f[2], 1};
            break;
        case Op::FogCoordf:
            floats(1);
            current.fog_coord = f[0];
            break;
        case Op::EdgeFlag: {
            std::uint32_t flag;
            std::memcpy(&flag, operand, 4);
            current.edge_flag = flag != 0;
            break;
        }
        case Op::MultiTexCoord4f:
        case Op::VertexAttrib4f: {
            std::uint32_t index;
            std::memcpy(&index, operand, sizeof index);
            operand += sizeof index;
            floats(4);
            auto& element = op == Op::MultiTexCoord4f ? current.texcoord[index] : current.vertex_attrib[index];
            element = {f[0], f[1], f[2], f[3]};
            break;
        }
        case Op::Indexf:
            floats(1);
            current.color_index = f[0];
            break;
        default: break;
    }
}

}  // namespace wall::client
