// SPDX-License-Identifier: MIT
#include "client_lib/follow/snapping.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "client_lib/process/options.h"
#include "client_lib/process/stats.h"

namespace wall::client {
namespace {

constexpr float kInAnyCase = std::numeric_limits<float>::infinity();
constexpr double kMicro = 1e6;

std::array<float, 2> scale_of(const SurfaceLayout& layout) {
    return {static_cast<float>(layout.rect.width) / static_cast<float>(layout.width),
            static_cast<float>(layout.rect.height) / static_cast<float>(layout.height)};
}

}  // namespace

Snapping::Snapping(Nodes& nodes, std::optional<float> asked) : nodes_(nodes), asked_(asked) {
    nodes_.before_sending([this] {
        if (parts_.empty()) return;
        reach_ = kInAnyCase;  // more blocks may come
        settle();
    });
}

/// The processes of a parallel program would have to be of one mind: what they draw may have edges in common.
float Snapping::bound() const { return parallel() ? 0 : std::min(asked_.value_or(allowed_), allowed_); }

/// In the next frame.
bool Snapping::is_wanted() {
    if (bound() <= 0 || asked_) return bound() > 0;
    std::uint64_t packed = 0, sent = 0;
    bool codes = false;
    for (const auto& node : nodes_) {
        if (!node->alive() || node->records()) continue;
        codes = codes || node->stream->codes();
        for (const auto kind : {NodeCounter::state_bytes, NodeCounter::object_bytes, NodeCounter::geometry_bytes})
            packed += stats().of_node(node->index, kind);
        sent += stats().of_node(node->index, NodeCounter::link_bytes);
    }
    if (codes) choice_.note_frame(packed, sent);
    return codes && choice_.moves();
}

// What is kept in a file may be shown larger some day.
void Snapping::begin_frame(const ClientSurface& surface) {
    const auto records = [](const auto& node) { return node->alive() && node->records(); };
    const bool wanted = is_wanted();
    if (!wanted && frames_.empty()) return;
    Frame& frame = frames_[surface.id];
    frame.snaps = wanted && std::ranges::none_of(nodes_, records);
    frame.pixels = bound();
    frame.before = std::exchange(frame.blocks, {});
    settle();
    nodes_.hold_more(std::ranges::any_of(frames_, [](const auto& one) { return one.second.snaps; }));
    grid_.reset();
    surface_ = {};
}

/// Whether there is a grid for it.
bool Snapping::begin_transformation(const glstate::Projection& projection, const ClientSurface& surface, float pixels) {
    const auto scale = scale_of(surface.layout);
    const auto& v = projection.viewport;
    const std::array<float, 6> place{v[0], v[1], v[2], v[3], scale[0], scale[1]};
    if (surface_ == surface.id && clip_ == projection.clip_from_object && place_ == place) return grid_.has_value();
    settle();
    surface_ = surface.id;
    clip_ = projection.clip_from_object;
    place_ = place;
    grid_ = SnapGrid::make(projection, scale, pixels);
    // What is kept of a hidden part is a copy.
    reach_ = surface.hidden ? kInAnyCase : 0;
    bytes_ = repeated_ = 0;
    exact_.reset();
    return grid_.has_value();
}

std::optional<glstate::Projection> Snapping::before_block(const DrawSource& source, Packer& packer,
                                                          const glstate::Projection& projection) {
    holds_ = false;
    if (frames_.empty() || packer.has_w() || !packer.has_geometry()) return std::nullopt;
    const ClientSurface* const surface = source.draw.pictured_surface();
    if (surface == nullptr || !source.draw.views().empty()) return std::nullopt;
    const auto found = frames_.find(surface->id);
    if (found == frames_.end() || !found->second.snaps) return std::nullopt;
    Frame& frame = found->second;
    const float pixels = frame.pixels;
    if (surface->layout.width == 0 || surface->layout.height == 0) return std::nullopt;
    if (!begin_transformation(projection, *surface, pixels)) return std::nullopt;
    const auto operands = packer.operands();
    const std::size_t hash =
        std::hash<std::string_view>()({reinterpret_cast<const char*>(operands.data()), operands.size()});
    frame.blocks.insert(hash);
    bytes_ += operands.size();
    if (frame.before.contains(hash)) repeated_ += operands.size();
    if (exact_.value_or(false)) return std::nullopt;
    if (reach_ == kInAnyCase) {
        exact_ = false;
        count(client::snap(packer, {}, packer.mark(), *grid_, reach_, options().count_ideal));
    } else {
        reach_ = std::max(reach_, reach_behind(packer, *grid_));
        holds_ = true;
    }
    glstate::Projection moved = projection;
    const auto scale = scale_of(surface->layout);
    const float off = pixels / std::min({scale[0], scale[1], 1.0f});  // window pixels
    moved.margin += off;
    moved.reaches.points += off;
    moved.reaches.lines += off;
    moved.reaches.polygons += off;
    return moved;
}

void Snapping::settle() {
    if (parts_.empty()) return;
    if (!exact_) exact_ = repeats();
    if (*exact_) return parts_.clear();
    Snapped all;
    for (const PackedPart& part : parts_) {
        Node& node = nodes_[part.node];
        if (node.batches != part.batch) continue;  // the node is lost, and what was packed for it
        const Snapped one = client::snap(node.batch, part.first, part.last, *grid_, reach_, options().count_ideal);
        all.vertices += one.vertices;
        all.farthest = std::max(all.farthest, one.farthest);
    }
    parts_.clear();
    count(all);
}

void Snapping::count(const Snapped& snapped) const {
    stats().add(Stats::kLossyVertices, snapped.vertices);
    if (options().count_ideal)
        stats().raise("lossy_micropixels", static_cast<std::uint64_t>(snapped.farthest * kMicro));
}

}  // namespace wall::client
