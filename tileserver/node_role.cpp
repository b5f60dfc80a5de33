// SPDX-License-Identifier: MIT
#include "tileserver/node_role.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include "common/base/whole_file.h"
#include "common/config/load_config.h"
#include "common/join/join.h"
#include "common/log/log.h"
#include "common/tls/identity.h"

namespace wall::tileserver {
namespace {

constexpr mode_t kWallFileMode = 0640;

Result<NodeKeys> keys_in(const std::string& folder) {
    const auto own = tls::Identity::load_or_make(join::key_file(folder));
    if (!own) return tl::unexpected(own.error());
    auto context = tls::TlsContext::make(*own);
    if (!context) return tl::unexpected(context.error());
    return NodeKeys{std::make_shared<const tls::TlsContext>(std::move(*context)), std::nullopt};
}

bool draws_otherwise(const std::vector<config::NodeConfig>& a, const std::vector<config::NodeConfig>& b) {
    return !std::ranges::equal(a, b, [](const auto& x, const auto& y) { return draws_as(x, y); });
}

bool file_has(const std::filesystem::path& path, const std::string& text) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    return file && content.view() == text;
}

}  // namespace

Result<void> NodeRole::join(const std::string& line, const std::string& state) {
    const auto parsed = tls::JoinLine::parse(line);
    if (!parsed) return tl::unexpected(parsed.error());
    const auto joined = join::join(*parsed, join::MachineKind::node, state);
    if (!joined) return tl::unexpected(joined.error());
    log::info("joined name={} walld={}", log::quoted(joined->name), log::quoted(joined->walld.text()));
    return {};
}

Result<NodeRole> NodeRole::of_joined(RoleSource source) {
    const auto joined = join::Membership::load(source.state);
    if (!joined) return tl::unexpected(joined.error());
    if (joined->kind != join::MachineKind::node)
        return fail(source.state + ": this machine has joined as a client host");
    auto wall = config::load_config(join::wall_file(source.state));
    if (!wall) return tl::unexpected(wall.error());
    auto keys = keys_in(source.state);
    if (!keys) return tl::unexpected(keys.error());
    NodeRole out;
    out.source_ = std::move(source);
    out.wall_ = std::move(*wall);
    out.name_ = joined->name;
    out.keys_ = std::move(*keys);
    out.keys_.joined = JoinedWall{joined->walld, joined->walld_key};
    return out;
}

Result<NodeRole> NodeRole::find(RoleSource source) {
    Result<NodeRole> out = NodeRole();
    if (source.config.empty()) {
        out = of_joined(std::move(source));
        if (!out) return out;
    } else {
        auto wall = config::load_config(source.config);
        if (!wall) return tl::unexpected(wall.error());
        auto keys = source.state.empty() ? Result<NodeKeys>(NodeKeys{}) : keys_in(source.state);
        if (!keys) return tl::unexpected(keys.error());
        out->name_ = source.node;
        out->source_ = std::move(source);
        out->wall_ = std::move(*wall);
        out->keys_ = std::move(*keys);
    }
    const auto& gpu = out->source_.gpu;
    const auto nodes = out->nodes();
    if (!nodes.empty() && (gpu.empty() || std::ranges::count(nodes, gpu, &config::NodeConfig::name) > 0)) return out;
    const auto file = out->keys_.joined ? join::wall_file(out->source_.state).string() : out->source_.config;
    if (nodes.empty()) return fail(file + ": no [[node]] has the name \"" + out->name_ + "\"");
    return fail(file + ": node \"" + out->name_ + "\" has no GPU \"" + gpu + "\"");
}

bool NodeRole::described(const std::string& wall_toml) const {
    const auto told = config::parse_config(wall_toml, "walld's wall.toml");
    if (!told) {
        log::error("description_unreadable reason={}", log::quoted(told.error().message));
        return false;
    }
    if (told->nodes_of(name_).empty()) {
        log::warn("taken_off_the_wall node={}", log::quoted(name_));
        return false;
    }
    if (keys_.joined) {
        const auto file = join::wall_file(source_.state);
        const auto kept = file_has(file, wall_toml) ? Result<void>() : write_whole(file, wall_toml, kWallFileMode);
        if (!kept) log::error("description_not_kept reason={}", log::quoted(kept.error().message));
        return kept && draws_otherwise(told->nodes_of(name_), nodes());
    }
    const auto here = config::load_config(source_.config);
    if (!here || draws_otherwise(here->nodes_of(name_), told->nodes_of(name_))) {
        log::warn("description_differs file={} node={}", log::quoted(source_.config), log::quoted(name_));
        return false;
    }
    return draws_otherwise(here->nodes_of(name_), nodes());
}

}  // namespace wall::tileserver
