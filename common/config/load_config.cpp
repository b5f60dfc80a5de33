// SPDX-License-Identifier: MIT
#include "common/config/load_config.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "common/base/lossy_pixels.h"
#include "common/config/eyes.h"
#include "common/config/parse_toml.h"
#include "common/config/read_gpus.h"
#include "common/config/read_output.h"
#include "common/config/read_people.h"
#include "common/config/read_roles.h"
#include "common/config/read_tile_output.h"
#include "common/config/read_view.h"

namespace wall::config {
namespace {

constexpr std::int64_t kMaxSwapTimeout = 10'000;   // ms
constexpr std::int64_t kMaxCloseTimeout = 60'000;  // ms
constexpr std::int64_t kMaxSessions = 10'000;
constexpr std::int64_t kMebibyte = 1 << 20, kMaxMebibytes = 1 << 20;
constexpr std::int64_t kMaxObjects = 1 << 20, kMaxFps = 1000, kMaxWindows = 256;
constexpr std::int64_t kMaxViews = 256, kMaxPictures = 128;  // walld/wall/quota.h
constexpr std::array kBackends{Backend::egl, Backend::osmesa};

std::uint32_t read_background(TreeReader& read, const toml::table& wall) {
    const auto text = read.text(wall, "background", "#000000");
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    if (text.size() == 7 && text[0] == '#' && std::from_chars(text.data() + 1, end, value, 16).ptr == end) return value;
    read.refuse(wall.get("background") ? wall.get("background")->source() : wall.source(),
                "'background': expected a colour as \"#RRGGBB\"");
    return 0;
}

void read_control(TreeReader& read, const toml::table& root, WallConfig& out) {
    const auto& control = read.section(root, "control");
    read.only(control, "[control]", {"listen", "users", "daemon_user"});
    out.daemon_user = read.text(control, "daemon_user", out.daemon_user);
    if (const auto* listen = control.get("listen")) {
        const auto* array = listen->as_array();
        if (!array || array->empty())
            read.refuse(listen->source(), "'listen': expected an array of addresses, unix:PATH or HOST:PORT");
        for (std::size_t i = 0; array && i < array->size(); ++i)
            out.control_listen.push_back(read.address(*array->get(i), "'listen'"));
    } else {
        out.control_listen.push_back({.path = {}, .host = "127.0.0.1", .port = net::kDefaultControlPort});
    }
    read_members(read, control, "users", out.people.users);
}

void read_http(TreeReader& read, const toml::table& root, WallConfig& out) {
    const auto* node = root.get("http");
    if (!node) return;
    const auto& http = read.section(root, "http");
    read.only(http, "[http]", {"listen"});
    const auto* listen = http.get("listen");
    if (!listen) {
        out.http_listen.push_back({.path = {}, .host = "127.0.0.1", .port = net::kDefaultHttpPort});
        return;
    }
    const auto* array = listen->as_array();
    if (array && array->empty()) read.refuse(listen->source(), "'listen' of [http]: expected an address, or several");
    for (std::size_t i = 0; i < (array ? array->size() : 1); ++i) {
        const auto& entry = array ? *array->get(i) : *listen;
        out.http_listen.push_back(read.address(entry, "'listen'"));
        if (out.http_listen.back().is_unix()) read.refuse(entry.source(), "'listen' of [http]: expected HOST:PORT");
    }
}

TileConfig read_tile(TreeReader& read, const toml::table& table, const geom::Vec3& eye) {
    read.only(table, "[[node.tile]]",
              {"name",  "rect",     "output", "display", "monitor",  "parent", "position", "mode",
               "gpu",   "rotation", "pixels", "size_mm", "bezel_mm", "warp",   "mpcdi",    "blend",
               "color", "yaw",      "pitch",  "roll",    "fov",      "screen", "eye",      "stereo"});
    TileConfig out{.name = read.text(table, "name"), .rect = read.rect(table, "rect")};
    read_output(read, table, out);
    out.gpu = read_gpu(read, table);
    read_tile_output(read, table, out);
    read_eyes(read, table, out);
    out.view = read_view(read, table, out.rect, eye);
    return out;
}

bool shows_two_eyes(const TileConfig& tile) { return tile.output.stereo != geom::StereoLayout::none; }

TriangleOrder read_triangle_order(TreeReader& read, const toml::table& table) {
    const auto text = read.text(table, "triangle_order", "auto");
    if (text == "auto") return TriangleOrder::automatic;
    if (text == "on") return TriangleOrder::on;
    if (text != "off")
        read.refuse(table.get("triangle_order")->source(),
                    "'triangle_order' is '" + text + "': expected \"auto\", \"on\" or \"off\"");
    return TriangleOrder::off;
}

NodeConfig read_node(TreeReader& read, const toml::table& table, const geom::Vec3& eye) {
    read.only(table, "[[node]]",
              {"name", "backend", "listen", "gpus", "triangle_order", "role", "partial_codec", "tile"});
    NodeConfig out;
    out.name = out.process = read.text(table, "name");
    const auto backend = read.text(table, "backend", "egl");
    const auto found = std::ranges::find(kBackends, backend, [](Backend b) { return std::string(name_of(b)); });
    if (found != kBackends.end()) out.backend = *found;
    else read.refuse(table.get("backend")->source(), "'backend' is '" + backend + "': expected \"egl\" or \"osmesa\"");
    out.triangle_order = read_triangle_order(read, table);
    out.roles = read_roles(read, table);
    out.partial_codec = read.text(table, "partial_codec", out.partial_codec);
    if (const auto* listen = table.get("listen")) out.listen = read.address(*listen, "'listen'");
    else out.listen = {.path = {}, .host = "127.0.0.1", .port = net::kDefaultDataPort};
    const auto tiles = tile_tables(read, table);
    for (const auto* tile : tiles) {
        out.tiles.push_back(read_tile(read, *tile, eye));
        check_output(read, *tile, out);
    }
    if (!out.roles.display && !out.tiles.empty())
        read.refuse(table.get("role")->source(),
                    "node '" + out.name + "' has tiles: expected \"display\" among its roles");
    const auto pictures = out.tiles.size() + static_cast<std::size_t>(std::ranges::count_if(out.tiles, shows_two_eyes));
    if (pictures > wire::kTileSlots)
        read.refuse(table.source(), "node '" + out.name + "' has " + std::to_string(pictures) +
                                        " tiles, counting those of two eyes twice: expected at most " +
                                        std::to_string(wire::kTileSlots));
    return out;
}

/// Names must be unique: they are how people and daemons point at things.
void read_nodes(TreeReader& read, const toml::table& root, WallConfig& out) {
    std::set<std::string> nodes, tiles;
    for (const auto* table : read.tables(root, "node", "[[node]]")) {
        out.nodes.push_back(read_node(read, *table, out.eye));
        const auto& node = out.nodes.back();
        if (!nodes.insert(node.name).second)
            read.refuse(table->source(), "node '" + node.name + "' appears twice: expected unique names");
        for (const auto& tile : node.tiles) {
            for (const auto& name : {tile.name, shows_two_eyes(tile) ? companion_name(tile.name) : std::string()})
                if (!name.empty() && !tiles.insert(name).second)
                    read.refuse(table->source(), "tile '" + name + "' appears twice: expected unique names");
        }
    }
}

/// What tiles say of each other.
void relate_tiles(TreeReader& read, const toml::table& root, WallConfig& wall) {
    if (read.error()) return;
    std::vector<DescribedTile> all;
    for (auto node = wall.nodes.begin(); const auto* table : read.tables(root, "node", "[[node]]")) {
        for (auto tile = node->tiles.begin(); const auto* of_tile : tile_tables(read, *table))
            all.push_back({of_tile, &*tile++});
        ++node;
    }
    place_behind_bezels(read, all);
    check_blends(read, all);
    check_eyes(read, all);
}

/// [quota]: what is left out is as much as there is.
QuotaConfig read_quota(TreeReader& read, const toml::table& root) {
    QuotaConfig out;
    const auto& quota = read.section(root, "quota");
    read.only(quota, "[quota]",
              {"program_memory", "program_objects", "program_bandwidth", "program_fps", "program_windows",
               "person_programs", "person_memory", "person_views", "person_pictures"});
    const auto figure = [&](const char* key, std::int64_t most, std::int64_t unit, auto& value) {
        if (quota.get(key))
            value = static_cast<typename std::remove_reference_t<decltype(value)>::value_type>(
                unit * read.integer(quota, key, 1, most, 1));
    };
    figure("program_memory", kMaxMebibytes, kMebibyte, out.program_memory);
    figure("program_objects", kMaxObjects, 1, out.program_objects);
    figure("program_bandwidth", kMaxMebibytes, kMebibyte, out.program_bandwidth);
    figure("program_fps", kMaxFps, 1, out.program_fps);
    figure("program_windows", kMaxWindows, 1, out.program_windows);
    figure("person_programs", kMaxSessions, 1, out.person_programs);
    figure("person_memory", kMaxMebibytes, kMebibyte, out.person_memory);
    figure("person_views", kMaxViews, 1, out.person_views);
    figure("person_pictures", kMaxPictures, 1, out.person_pictures);
    return out;
}

/// Whose geometry may be dealt to nodes: of programs that ask for it, or of all, where that is faster.
bool read_sort_last(TreeReader& read, const toml::table& wall) {
    const auto given = read.text(wall, "sort_last", "asked");
    if (given != "asked" && given != "measured")
        read.refuse(wall.get("sort_last")->source(),
                    "'sort_last' is '" + given + "': expected \"asked\" or \"measured\"");
    return given == "measured";
}

WallConfig read_wall(TreeReader& read, const toml::table& root) {
    WallConfig out;
    read.only(root, "the file", {"wall", "control", "http", "people", "quota", "node"});
    const auto& wall = read.section(root, "wall");
    read.only(wall, "[wall]",
              {"name", "background", "swap_timeout_ms", "close_timeout_ms", "max_sessions", "state_directory", "eye",
               "lossy_pixels", "sort_last"});
    out.name = read.text(wall, "name", "wall");
    out.background = read_background(read, wall);
    out.swap_timeout =
        std::chrono::milliseconds(read.integer(wall, "swap_timeout_ms", 1, kMaxSwapTimeout, out.swap_timeout.count()));
    out.close_timeout = std::chrono::milliseconds(
        read.integer(wall, "close_timeout_ms", 0, kMaxCloseTimeout, out.close_timeout.count()));
    out.max_sessions =
        static_cast<std::uint32_t>(read.integer(wall, "max_sessions", 1, kMaxSessions, out.max_sessions));
    out.lossy_pixels = static_cast<float>(read.number(wall, "lossy_pixels", 0, kMostLossyPixels, 0));
    out.sort_last_measured = read_sort_last(read, wall);
    if (wall.get("state_directory")) out.state_directory = read.text(wall, "state_directory");
    out.eye = read_eye(read, wall);
    read_control(read, root, out);
    read_people(read, root, out.people);
    out.quota = read_quota(read, root);
    read_http(read, root, out);
    read_nodes(read, root, out);
    relate_tiles(read, root, out);
    read_gpus(read, root, out.nodes);
    std::ranges::for_each(out.nodes, add_companions);
    return out;
}

}  // namespace

Result<WallConfig> parse_config(std::string_view toml, std::string_view file_name) {
    return parse_toml(toml, file_name, read_wall);
}

Result<std::vector<NodeConfig>> parse_nodes(std::string_view toml, std::string_view file_name, const geom::Vec3& eye) {
    return parse_toml(toml, file_name, [&eye](TreeReader& read, const toml::table& root) {
        WallConfig out;
        out.eye = eye;
        read.only(root, "the nodes", {"node"});
        read_nodes(read, root, out);
        read_gpus(read, root, out.nodes);
        std::ranges::for_each(out.nodes, add_companions);
        return out.nodes;
    });
}

Result<WallConfig> load_config(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return fail(path + ": cannot be read: expected a wall description (docs/operation.md)");
    std::ostringstream text;
    text << file.rdbuf();
    return parse_config(text.str(), path);
}

}  // namespace wall::config
