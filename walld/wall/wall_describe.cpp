// SPDX-License-Identifier: MIT
// What of the wall follows its description: which nodes and tiles there are, from the start and when wall.toml changes
// while programs run. A node keeps its number as long as walld runs. One whose tiles change takes them while it draws
// for the old ones (the layers of new ones begin empty); when all have them the programs are told, which take the other
// tiles at their next frames, with a placement, as they take a move. A node whose process cannot go on so leaves, and
// comes back as one that knows nothing.
#include <algorithm>
#include <utility>

#include "walld/wall/messages.h"
#include "walld/wall/placement.h"
#include "walld/wall/wall.h"

namespace wall::walld {

std::optional<NodeIndex> Wall::find_node(std::string_view name) const {
    for (const NodeIndex i : nodes_.ids())
        if (nodes_[i].config->name == name) return i;
    return std::nullopt;
}

std::vector<NodeIndex> Wall::nodes_called(std::string_view name) const {
    std::vector<NodeIndex> out;
    for (const NodeIndex i : nodes_.ids()) {
        const auto& config = *nodes_[i].config;
        if (nodes_[i].duty != Duty::gone && (config.name == name || config.process == name)) out.push_back(i);
    }
    return out;
}

/// Those of config_; others are gone. True: some are others than before.
bool Wall::take_nodes() {
    bool changed = false;
    for (const NodeIndex i : nodes_.ids()) {
        Node& node = nodes_[i];
        if (node.duty == Duty::gone || config_.find_node(node.config->name)) continue;
        node.duty = Duty::gone;
        node.config = std::make_shared<const config::NodeConfig>(config::NodeConfig{.name = node.config->name});
        node.shown.clear();
        changed = true;
    }
    for (const auto& config : config_.nodes) {
        auto index = find_node(config.name);
        if (index && nodes_[*index].duty != Duty::gone && draws_as(*nodes_[*index].config, config)) {
            changed = take_rest(*index, config) || changed;
            continue;
        }
        if (!index) {
            index = NodeIndex(static_cast<std::uint32_t>(nodes_.size()));
            nodes_.push_back({});
        }
        Node& node = nodes_[*index];
        node.config = std::make_shared<const config::NodeConfig>(config);
        if (node.duty == Duty::gone) node.duty = Duty::serves;
        node.described_anew = node.incarnation > 0;
        node.shown.clear();
        changed = true;
    }
    end_crossed_recordings();
    return changed;
}

/// What a node goes on with: it shows its tiles otherwise from the next picture on. True: programs must draw otherwise.
bool Wall::take_rest(NodeIndex node, const config::NodeConfig& config) {
    Node& now = nodes_[node];
    if (*now.config == config) return false;
    const bool same = same_tiles(*now.config, config);
    now.config = std::make_shared<const config::NodeConfig>(config);
    std::erase_if(now.shown, [&](const auto& shown) { return config.tile(shown.first) == nullptr; });
    if (now.up && !same) {
        ++now.tiles_version;
        taking_tiles_.insert(node);
    } else if (!same) {
        now.described_anew = now.incarnation > 0;
    }
    if (now.up) welcome_node(node);
    return !same;
}

std::vector<NodeIndex> Wall::described_otherwise(const config::WallConfig& next) const {
    std::vector<NodeIndex> out;
    for (const NodeIndex i : nodes_.ids()) {
        const auto* described = next.find_node(nodes_[i].config->name);
        if (nodes_[i].duty != Duty::gone && (!described || !draws_as(*described, *nodes_[i].config))) out.push_back(i);
    }
    return out;
}

void Wall::describe(config::WallConfig next) {
    moving_.reset();
    const bool other_background = next.background != config_.background, other_quota = next.quota != config_.quota;
    config_ = std::move(next);
    const bool other_tiles = take_nodes();
    std::erase_if(patterns_, [&](const auto& shown) {
        return std::ranges::none_of(config_.nodes, [&](const auto& node) {
            return std::ranges::count(node.tiles, shown.first, &config::TileConfig::name) > 0;
        });
    });
    for (const NodeIndex i : nodes_.ids())
        if (other_background && nodes_[i].up) welcome_node(i);
    for (auto& [id, session] : sessions_)
        for (const NodeIndex i : nodes_.ids())
            if (other_quota && nodes_[i].up && session.tickets.contains(i)) hand_out_ticket(id, session, i);
    tiles_untold_ = tiles_untold_ || other_tiles;
    tell_tiles();
}

void Wall::node_took_tiles(NodeIndex node, std::uint32_t version) {
    if (version != nodes_[node].tiles_version) return;
    if (taking_tiles_.erase(node) > 0) out_.to_node(node, stacking_message(node));
    tell_tiles();
}

/// To programs, if it is time.
void Wall::tell_tiles() {
    if (!taking_tiles_.empty() || !std::exchange(tiles_untold_, false)) return;
    if (moving_) moving_->told = true;
    proto::TilesChanged tiles;
    add_tiles(*tiles.mutable_tiles());
    for (auto& [id, session] : sessions_) {
        if (session.fullscreen) session.rect = config_.canvas();
        out_.to_client(id, make(&proto::Envelope::mutable_tiles_changed, tiles));
    }
    for_each_surface([&](const SurfaceKey& key, SurfaceEntry& surface) {
        want(key, place_after_change(*find(key.session), surface));
    });
}

/// Where it was, if that is on the wall.
geom::Rect Wall::place_after_change(const SessionEntry& session, const SurfaceEntry& surface) {
    const auto canvas = config_.canvas();
    if (surface.wanted_rect && session.fullscreen) return canvas;
    const auto rect = surface.place.wanted();
    if (check_place(canvas, rect)) return rect;
    return place(canvas, {}, rect.width, rect.height, windows_placed_++);
}

void Wall::add_tiles(google::protobuf::RepeatedPtrField<proto::TileInfo>& out) const {
    for (const NodeIndex i : nodes_.ids()) {
        for (const auto& tile : nodes_[i].config->tiles) {
            auto& entry = *out.Add();
            entry.set_node(i.value);
            entry.set_slot(tile.slot);
            entry.set_name(tile.name);
            *entry.mutable_rect() = to_proto(tile.rect);
            if (tile.view) *entry.mutable_view() = to_proto(*tile.view);
            entry.set_eye(static_cast<std::uint32_t>(tile.eye));
        }
    }
}

/// A drained node keeps nothing of the programs, which do not know that it is here.
void Wall::send_away(const proto::NodeHello& hello, NodeIndex node) {
    nodes_[node].described_anew = true;  // what it gets later are other tickets
    for (auto& [id, session] : sessions_) session.tickets.erase(node);
    for (const auto& known : hello.sessions()) {
        proto::SessionEnd end;
        end.set_session(known.session());
        out_.to_node(node, make(&proto::Envelope::mutable_session_end, end));
    }
}

}  // namespace wall::walld
