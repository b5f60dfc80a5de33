// SPDX-License-Identifier: MIT
#include "walld/control/description_desk.h"

#include <algorithm>

#include "common/config/kept_tiles.h"
#include "common/log/log.h"
#include "walld/control/arguments.h"
#include "walld/wall/messages.h"

namespace wall::walld {
namespace {

using nlohmann::json;

/// What only a new process can take, if the descriptions differ in it.
const char* fixed_difference(const config::WallConfig& before, const config::WallConfig& after) {
    if (before.control_listen != after.control_listen) return "'listen' in [control]";
    if (before.daemon_user != after.daemon_user) return "'daemon_user' in [control]";
    if (before.http_listen != after.http_listen) return "[http]";
    if (before.state_directory != after.state_directory) return "'state_directory' in [wall]";
    if (before.swap_timeout != after.swap_timeout) return "'swap_timeout_ms' in [wall]";
    return nullptr;
}

}  // namespace

DescriptionDesk::DescriptionDesk(WallFile file, std::string toml, std::filesystem::path state, const Told& told)
    : file_(std::move(file)), toml_(std::move(toml)), state_(std::move(state)), told_(told) {
    told_.machines.set_wall_toml(toml_);
    drain();
}

/// Nodes that were drained, by their own name or their tileserver's, and have come (again) with a description.
void DescriptionDesk::drain() const {
    const auto drained = file_.drained();
    if (!drained) {
        log::error("drained_unknown reason={}", log::quoted(drained.error().message));
        return;
    }
    for (const auto& name : *drained)
        for (const auto node : told_.wall.nodes_called(name)) told_.wall.set_duty(node, Duty::drained);
}

void DescriptionDesk::tell(NodeIndex node) const {
    proto::WallDescription message;
    message.set_wall_toml(toml_);
    told_.out.to_node(node, make(&proto::Envelope::mutable_wall_description, message));
}

Outcome<json> DescriptionDesk::reload() { return take(file_.read()); }

Outcome<json> DescriptionDesk::add(const json& arguments) {
    return text_of(arguments, "toml").and_then([&](const std::string& text) { return take(file_.add(text)); });
}

Outcome<json> DescriptionDesk::remove(const json& arguments) {
    return text_of(arguments, "name").and_then([&](const std::string& name) { return take(file_.remove(name)); });
}

Outcome<json> DescriptionDesk::take(Outcome<Description> next) {
    if (!next) return tl::unexpected(next.error());
    Wall& wall = told_.wall;
    if (const char* fixed = fixed_difference(wall.config(), next->config))
        return refuse(RefusalKind::conflict, std::string(fixed) +
                                                 " has changed, which walld takes only when it starts "
                                                 "(`systemctl restart walld`): nothing was changed");
    config::keep_tiles(next->config, wall.config());
    auto identities = Identities::open(next->config.people, state_);
    if (!identities) return refuse(RefusalKind::invalid, identities.error().message);
    told_.identities = std::move(*identities);
    told_.who.forget();
    toml_ = std::move(next->toml);
    told_.machines.set_wall_toml(toml_);

    const auto known = wall.nodes().size();
    const auto others = wall.described_otherwise(next->config);
    json names = json::array();
    for (const NodeIndex node : others) {
        names.push_back(wall.nodes()[node].config->name);
        tell(node);
        told_.links.let_go(node, "it is described otherwise");
    }
    wall.describe(std::move(next->config));
    drain();
    for (const NodeIndex node : wall.nodes().ids()) {
        if (node.value >= known) names.push_back(wall.nodes()[node].config->name);
        if (std::ranges::count(others, node) == 0) tell(node);
    }
    told_.streams.wall_changed(Clock::now());
    std::size_t tiles = 0;
    for (const auto& node : wall.config().nodes) tiles += node.tiles.size();
    return json{{"nodes", names}, {"tiles", tiles}};
}

Outcome<json> DescriptionDesk::set_drained(const json& arguments, bool on) {
    const auto name = text_of(arguments, "name");
    if (!name) return tl::unexpected(name.error());
    Wall& wall = told_.wall;
    const auto nodes = wall.nodes_called(*name);
    if (nodes.empty()) return refuse(RefusalKind::not_found, "there is no node '" + *name + "'");
    auto drained = file_.drained();
    if (!drained) return tl::unexpected(drained.error());
    // A tileserver is drained by its name if all of its GPUs are: so it stays when it has others. Those that are gone
    // stay what they were, if they come again.
    const auto is_drained = [&](NodeIndex node) {
        return std::ranges::count(nodes, node) > 0 ? on : wall.nodes()[node].duty == Duty::drained;
    };
    for (const auto& config : wall.config().nodes) {
        const auto of_process = wall.nodes_called(config.process);
        const bool all = std::ranges::all_of(of_process, is_drained);
        for (const NodeIndex node : of_process) {
            const auto& its_name = wall.nodes()[node].config->name;
            if (is_drained(node) && !all) drained->insert(its_name);
            else drained->erase(its_name);
        }
        if (all) drained->insert(config.process);
        else if (of_process.size() > 1) drained->erase(config.process);
    }
    if (auto kept = file_.set_drained(*drained); !kept) return tl::unexpected(kept.error());
    const auto duty = on ? Duty::drained : Duty::serves;
    for (const NodeIndex node : nodes) {
        if (wall.nodes()[node].duty == duty) continue;
        told_.links.let_go(node, on ? "an operator drains it" : "it serves the wall again");
        wall.set_duty(node, duty);
    }
    return json::object();
}

}  // namespace wall::walld
