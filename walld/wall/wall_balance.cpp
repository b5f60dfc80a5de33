// SPDX-License-Identifier: MIT
// Tiles that were dealt out among the GPUs of a tileserver go to another one where that is measured to pay
// (OCTAVIS 5.3). No frame is wrong meanwhile: first both GPUs draw the tile, and the old one shows it; when every
// window on it has shown a frame that both have drawn, the new one shows it, and the old one drops it.
//
//   measured --better_place--> both draw --all windows are settled--> the new one shows it
//                                  | a node goes, or kSettleLimit
//                                  v
//                              as before
#include <algorithm>
#include <utility>

#include "common/config/eyes.h"
#include "common/log/log.h"
#include "walld/wall/wall.h"

namespace wall::walld {
namespace {

constexpr std::chrono::seconds kWindow{4};       // over which times are averaged
constexpr std::chrono::seconds kSettleLimit{5};  // for every window to have drawn for both
constexpr std::chrono::seconds kRest{60};        // until a tile that was moved, or could not be, may move again

}  // namespace

bool Wall::may_be_balanced(NodeIndex node) const {
    const auto& config = *nodes_[node].config;
    return nodes_called(config.process).size() > 1 && std::ranges::any_of(config.tiles, &config::TileConfig::dealt);
}

/// Of one node, once there are reports of kWindow.
void Wall::take_tile_times(NodeIndex node) {
    TileTimes& times = nodes_[node].times;
    const proto::NodeStats& now = nodes_[node].stats;
    const auto since = [](const auto& rows, std::uint32_t slot) {
        const auto found = std::ranges::find(rows, slot, [](const auto& row) { return row.slot(); });
        return found == rows.end() ? std::uint64_t{0} : found->ns();
    };
    const bool first = times.first.time_us() == 0 || now.time_us() < times.first.time_us();
    if (!first) {
        const auto taken = std::chrono::microseconds(now.time_us() - times.first.time_us());
        if (taken < kWindow) return;
        times.loads.clear();
        for (const auto& row : now.tile_times()) {
            const auto before = since(times.first.tile_times(), row.slot());
            const auto ns = row.ns() >= before ? row.ns() - before : 0;
            times.loads[row.slot()] = static_cast<double>(ns) / 1e3 / static_cast<double>(taken.count());
        }
        times.known = true;
    }
    times.first = now;
}

void Wall::balance(NodeIndex reporting, Clock::time_point now) {
    if (!may_be_balanced(reporting)) return;
    take_tile_times(reporting);
    if (moving_) return;
    const auto gpus = nodes_called(nodes_[reporting].config->process);
    if (!std::ranges::all_of(gpus, [&](NodeIndex i) { return nodes_[i].up && nodes_[i].times.known; })) return;
    std::vector<TileLoad> loads;
    for (const NodeIndex gpu : gpus) {
        for (const auto& tile : nodes_[gpu].config->tiles) {
            const auto rests = resting_.find(tile.name);
            const bool stays = !tile.dealt || (rests != resting_.end() && now < rests->second);
            const auto load = nodes_[gpu].times.loads.find(tile.slot);
            loads.push_back({tile.name, gpu, load == nodes_[gpu].times.loads.end() ? 0 : load->second, stays});
        }
        nodes_[gpu].times.known = false;
    }
    const auto better = better_place(gpus, loads);
    if (better) begin_move(*better, now);
}

/// The description with the node as it is from now on.
void Wall::describe_node(NodeIndex node, config::NodeConfig config) {
    const auto entry = std::ranges::find(config_.nodes, config.name, &config::NodeConfig::name);
    if (entry != config_.nodes.end()) *entry = config;
    tiles_untold_ = take_rest(node, config) || tiles_untold_;
}

void Wall::begin_move(const BetterPlace& better, Clock::time_point now) {
    const auto from = node_of_tile(better.tile);
    if (!from) return;
    config::NodeConfig with = *nodes_[better.to].config;
    TileMove move{better.tile, *from, better.to, {}, now + kSettleLimit, false};
    for (const auto& tile : nodes_[*from].config->tiles) {
        const bool right_eye = tile.name == config::companion_name(better.tile);
        if (tile.name != better.tile && !right_eye) continue;
        move.slots.push_back(tile.slot);
        auto& added = with.tiles.emplace_back(tile);
        added.gpu = nodes_[better.to].config->gpu();
        added.arriving = true;
    }
    log::info("tile_moves tile={} from={} to={} gain={:.2f}", log::quoted(better.tile),
              log::quoted(nodes_[*from].config->name), log::quoted(with.name), better.gain);
    moving_ = std::move(move);
    describe_node(better.to, std::move(with));
    tell_tiles();
}

/// Every window there has shown a frame that both have drawn.
bool Wall::move_is_settled() const {
    const auto* tile = nodes_[moving_->from].config->tile(moving_->slots.front());
    for (const auto& [id, session] : sessions_)
        for (const auto& [surface_id, surface] : session.surfaces)
            if (geom::overlaps(surface.place.wanted(), tile->rect) && !surface.place.settled()) return false;
    return true;
}

void Wall::go_on_moving(Clock::time_point now) {
    if (!moving_) return;
    if (now >= moving_->until) return end_move(false, now);
    if (moving_->told && move_is_settled()) end_move(true, now);
}

void Wall::end_move(bool there, Clock::time_point now) {
    const TileMove move = *std::exchange(moving_, std::nullopt);
    const auto is_moved = [&](const config::TileConfig& tile) { return std::ranges::count(move.slots, tile.slot) > 0; };
    config::NodeConfig from = *nodes_[move.from].config, to = *nodes_[move.to].config;
    if (there) {
        std::erase_if(from.tiles, is_moved);
        for (auto& tile : to.tiles) tile.arriving = false;
        describe_node(move.from, std::move(from));
    } else {
        std::erase_if(to.tiles, is_moved);
    }
    describe_node(move.to, std::move(to));
    resting_[move.tile] = now + kRest;
    for (const NodeIndex gpu : nodes_called(nodes_[move.to].config->process)) nodes_[gpu].times = {};
    if (there) ++tiles_moved_;
    log::info("tile_moved tile={} there={}", log::quoted(move.tile), there);
    tell_tiles();
}

}  // namespace wall::walld
