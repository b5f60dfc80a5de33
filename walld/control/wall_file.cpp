// SPDX-License-Identifier: MIT
#include "walld/control/wall_file.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "common/base/whole_file.h"
#include "common/config/load_config.h"
#include "common/json/parse_json.h"
#include "walld/control/names.h"

namespace wall::walld {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
constexpr const char* kEnding = ".toml";
constexpr mode_t kMode = 0640;
constexpr const char* kNoState =
    "walld has no state directory to keep that in ('state_directory' in [wall] of wall.toml)";

tl::unexpected<Refusal> failed(const fs::path& path, const std::string& what) {
    return refuse(RefusalKind::failed, path.string() + ": " + what);
}

Outcome<std::string> content_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) return failed(path, "cannot be read");
    return text.str();
}

Outcome<void> keep(const fs::path& path, const std::string& text) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) return failed(path.parent_path(), error.message());
    if (auto written = write_whole(path, text, kMode); !written)
        return refuse(RefusalKind::failed, written.error().message);
    return {};
}

}  // namespace

/// `name`: of the text, for people.
Outcome<Description> WallFile::described(std::string toml, const std::string& name) const {
    auto config = config::parse_config(toml, name);
    if (!config) return refuse(RefusalKind::invalid, config.error().message);
    if (auto loaded = files_.load(*config, fs::path(path_).parent_path()); !loaded)
        return refuse(RefusalKind::invalid, loaded.error().message);
    return Description{std::move(*config), std::move(toml)};
}

Outcome<fs::path> WallFile::file_of(const std::string& node) const {
    if (state_.empty()) return refuse(RefusalKind::unavailable, kNoState);
    if (may_name_file(node)) return folder() / (node + kEnding);
    return refuse(RefusalKind::invalid, "the name of a node that is added has " + file_name_rule());
}

/// wall.toml, then the nodes that were added, in the order of their names.
Outcome<std::string> WallFile::text() const {
    auto out = content_of(path_);
    if (!out || state_.empty()) return out;
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator at(folder(), error), end; !error && at != end; at.increment(error))
        if (at->path().extension() == kEnding && may_name_file(at->path().stem().string())) files.push_back(at->path());
    if (error && error != std::errc::no_such_file_or_directory) return failed(folder(), error.message());
    std::ranges::sort(files);
    for (const auto& file : files) {
        const auto node = content_of(file);
        if (!node) return tl::unexpected(node.error());
        *out += "\n" + *node;
    }
    return out;
}

Outcome<Description> WallFile::read() const {
    const auto alone = config::load_config(path_);  // for an error with the right line
    if (!alone) return refuse(RefusalKind::invalid, alone.error().message);
    auto whole = text();
    if (!whole) return tl::unexpected(whole.error());
    return described(std::move(*whole), path_ + " with the nodes of " + folder().string());
}

Outcome<Description> WallFile::add(const std::string& nodes) const {
    const auto before = read();
    const auto added = config::parse_nodes(nodes, "the node", before ? before->config.eye : geom::Vec3{});
    if (!added) return refuse(RefusalKind::invalid, added.error().message);
    std::set<std::string> names;
    for (const auto& node : *added) names.insert(node.process);
    if (names.size() != 1)
        return refuse(RefusalKind::invalid,
                      "the node: expected one [[node]] table, not " + std::to_string(names.size()));
    const auto& name = *names.begin();
    const auto file = file_of(name);
    if (!file) return tl::unexpected(file.error());
    if (!before) return before;
    if (!before->config.nodes_of(name).empty())
        return refuse(RefusalKind::conflict, "the wall has a node '" + name + "' already");
    auto after = described(before->toml + "\n" + nodes, path_ + " with the node '" + name + "'");
    if (!after) return after;
    if (auto kept = keep(*file, nodes); !kept) return tl::unexpected(kept.error());
    return after;
}

Outcome<Description> WallFile::remove(const std::string& node) const {
    const auto before = read();
    if (!before) return before;
    if (before->config.nodes_of(node).empty()) return refuse(RefusalKind::not_found, "there is no node '" + node + "'");
    const auto file = state_.empty() || !may_name_file(node) ? fs::path() : folder() / (node + kEnding);
    std::error_code error;
    if (file.empty() || !fs::exists(file, error))
        return refuse(RefusalKind::conflict, "node '" + node + "' stands in " + path_ +
                                                 ": take it out there, then `wallctl reload` (`wallctl node drain` "
                                                 "takes it off the wall meanwhile)");
    const auto kept = content_of(file);
    if (!kept) return tl::unexpected(kept.error());
    if (!fs::remove(file, error)) return failed(file, error.message());
    auto after = read();
    // A wall has a node; and nothing is lost when the rest makes no sense.
    if (!after && keep(file, *kept)) return after;
    return after;
}

Outcome<std::set<std::string>> WallFile::drained() const {
    const auto file = state_ / "drained.json";
    std::error_code error;
    if (state_.empty() || !fs::exists(file, error)) return std::set<std::string>();
    const auto text = content_of(file);
    if (!text) return tl::unexpected(text.error());
    const auto names = parse_json(*text, kFileJson);
    const auto is_text = [](const json& name) { return name.is_string(); };
    if (!names || !names->is_array() || !std::ranges::all_of(*names, is_text))
        return failed(file, "expected an array of nodes' names");
    return names->get<std::set<std::string>>();
}

Outcome<void> WallFile::set_drained(const std::set<std::string>& nodes) const {
    if (state_.empty()) return {};  // until walld ends, then
    return keep(state_ / "drained.json", json(nodes).dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace wall::walld
