// SPDX-License-Identifier: MIT
// Who follows a process's contexts: its nodes, brought up to date when they draw, and what is kept for the parts of
// windows that no tile shows. The session's mutex is held.
#pragma once

#include <mutex>
#include <optional>

#include "client_lib/follow/dealer.h"
#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/drawn_parts.h"
#include "client_lib/follow/hidden_parts.h"
#include "client_lib/follow/named_objects.h"
#include "client_lib/follow/node_updater.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/follow/open_block.h"
#include "client_lib/follow/window_content.h"
#include "client_lib/geometry/sight.h"
#include "client_lib/process/options.h"
#include "common/glstate/draw_buffers.h"

namespace wall::client {

struct Followers {
    Nodes& nodes;
    NodeUpdater& updater;
    HiddenParts& hidden;
    Dealer& dealer;
    WindowContents& windows;
    DrawnParts& drawn;
    Sight& sight;
};

/// Before the first node is told of a draw: all that it goes to have what only others have, as it is now; and what
/// somebody keeps is done with the images that are drawn to.
inline void before_drawing(const Followers& followers, const DrawSource& source) {
    const bool writes = source.objects.writes();
    followers.windows.bring(source.draw);
    followers.drawn.before_drawing(source);
    if (source.draw.of_objects() || writes) followers.hidden.before_drawing_to(source);
    if (writes || source.share->has_drawn.load(std::memory_order_relaxed)) bring_drawn(followers.nodes, source);
}

/// Something was drawn on all nodes that it goes to.
inline void note_content(const DrawSource& source) {
    source.draw.note_content(*source.share);
    if (!source.objects.writes()) return;
    std::lock_guard lock(source.share->mutex);
    source.objects.note_written();
    source.share->has_drawn.store(true, std::memory_order_relaxed);
}

/// Where on the draw target it is, in each of its views. Good until the next call.
inline Reach reach_of(const Followers& followers, const DrawSource& source, const Drawn& drawn) {
    if (drawn.clip) {
        followers.sight.aim(*drawn.seen_by, source.draw.views());
        return followers.sight.of_image(drawn);
    }
    if (drawn.projection == nullptr) return drawn.rect;
    followers.sight.aim(*drawn.projection, source.draw.views());
    return drawn.mode ? followers.sight.of(*drawn.box, *drawn.mode) : followers.sight.of(*drawn.box);
}

/// Runs `pack(buffer)` inside a Block on every layer of the draw target that `drawn` touches, whose nodes have what it
/// names (named_objects.h) then.
template <class Named, class Pack>
void draw_on(const Followers& followers, const DrawSource& source, const Drawn& drawn, const Needs& needs,
             const Named& named, Pack&& pack) {
    if (!source.draw) return;
    const bool everywhere = options().broadcast || glstate::counts_primitives(source.state) || source.objects.writes();
    if (drawn.seen_by != nullptr) source.draw.note_camera(*drawn.seen_by, drawn.box);
    const Reach reach = everywhere ? Reach() : reach_of(followers, source, drawn);
    before_drawing(followers, source);
    const auto pack_block = [&](wire::PackBuffer& buffer, std::uint64_t slots) {
        const OpenBlock block = begin_block(buffer, slots);
        pack(buffer);
        end_block(buffer, block);
    };
    auto& [nodes, updater, hidden, dealer, windows, parts, sight] = followers;
    if (KeptFrame* const kept = hidden.begin_keeping(source, reach.window)) {
        Node& node = nodes[kept->layer];
        bring_named(nodes, node, source, named, nodes.batch(node, source.id));
        pack_block(hidden.prepare(*kept, source, needs), kept->layer.bit());
        note_named(kept->follower, source, named);
        named.note_drawn(kept->follower);
    }
    using Parts = std::span<const Dealer::Dealt>;
    const Parts dealt = everywhere ? Parts() : dealer.deal(source, reach, drawn.elements, drawn.pieces);
    if (dealt.empty()) dealer.compose(source.draw);
    if (drawn.elements == 0) dealer.compose(source.read);  // it may be a copy
    const NodeMasks& touched = nodes.touched(source.draw.layers(), reach);
    updater.prepare_all(dealt.empty() ? touched : dealer.dealt_to(), source, named);
    for (const Dealer::Dealt& part : dealt) {
        if (part.mask == 0 || !part.node->alive()) continue;
        wire::PackBuffer& buffer = dealer.prepare(*part.node, source, needs);
        bring_named(nodes, *part.node, source, named, buffer);
        const std::size_t bytes = buffer.bytes();
        const OpenBlock block = begin_block(buffer, part.mask);
        if (part.behind != 0) glapi::pack::PieceRange(buffer, part.first, part.behind);
        pack(buffer);
        end_block(buffer, block);
        count(*part.node, NodeCounter::geometry_bytes, buffer.bytes() - bytes);
        named.note_drawn(*part.node);
    }
    for (const auto& [index, slots] : touched) {
        Node& node = nodes[index];
        if (!source.draw.goes_to(node) || (!dealt.empty() && !node.records())) continue;
        wire::PackBuffer& buffer = updater.prepare(node, source, needs);
        bring_named(nodes, node, source, named, buffer);
        const std::size_t bytes = buffer.bytes();
        pack_block(buffer, slots);
        count(node, NodeCounter::geometry_bytes, buffer.bytes() - bytes);
        named.note_drawn(node);
    }
    note_content(source);
}

}  // namespace wall::client
