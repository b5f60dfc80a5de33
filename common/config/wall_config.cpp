// SPDX-License-Identifier: MIT
// toml++ gives the tree; TreeReader walks it with a sticky first error, so that the reading code is one line a key.
#include "common/config/wall_config.h"

#include <pwd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_UNRELEASED_FEATURES 0
#include <toml++/toml.h>

#include "common/config/toml_guard.h"
#include "common/wire/limits.h"

namespace wall::config {
namespace {

constexpr std::int64_t kMaxCanvas = wire::kMaxSurfaceExtent;  // pixels a side: a surface may cover all of it
constexpr std::int64_t kMaxSwapTimeout = 10'000;   // ms
constexpr std::array kBackends{Backend::egl, Backend::osmesa};

class TreeReader {
public:
    explicit TreeReader(std::string_view file) : file_(file) {}

    const std::optional<Error>& error() const { return error_; }

    void refuse(const toml::source_region& where, std::string_view what) {
        if (!error_) error_ = Error{file_ + ":" + std::to_string(std::max(1u, where.begin.line)) + ": " + from_private_use(what)};
    }

    /// Every key of `table` must be one of `known`.
    void only(const toml::table& table, std::string_view name, std::initializer_list<std::string_view> known) {
        for (const auto& [key, value] : table) {
            if (std::ranges::find(known, key.str()) != known.end()) continue;
            std::string list;
            for (const auto k : known) list += (list.empty() ? "" : ", ") + std::string(k);
            refuse(key.source(), "unknown key '" + std::string(key.str()) + "' in " + std::string(name) + ": expected one of " + list);
        }
    }

    std::string text(const toml::table& table, std::string_view key, std::optional<std::string> otherwise = {}) {
        const auto* node = need(table, key, "a string", otherwise.has_value());
        if (!node) return otherwise.value_or("");
        if (const auto* value = node->as_string()) {
            if (value->get().empty()) refuse(node->source(), quoted(key) + " is empty: expected a string");
            return from_private_use(value->get());
        }
        refuse(node->source(), quoted(key) + ": expected a string");
        return {};
    }

    std::int64_t integer(const toml::table& table, std::string_view key, std::int64_t least, std::int64_t most, std::int64_t otherwise) {
        const auto* node = table.get(key);
        if (!node) return otherwise;
        return integer(*node, quoted(key), least, most);
    }
    std::int64_t integer(const toml::node& node, const std::string& what, std::int64_t least, std::int64_t most) {
        const auto* value = node.as_integer();
        if (value && value->get() >= least && value->get() <= most) return value->get();
        refuse(node.source(), what + ": expected an integer from " + std::to_string(least) + " to " + std::to_string(most));
        return least;
    }

    net::Address address(const toml::node& node, const std::string& what) {
        const auto* value = node.as_string();
        auto parsed = value ? net::Address::parse(from_private_use(value->get())) : fail("expected a string, unix:PATH or HOST:PORT");
        if (parsed) return *parsed;
        refuse(node.source(), what + ": " + parsed.error().message);
        return {};
    }

    geom::Rect rect(const toml::table& table, std::string_view key) {
        constexpr std::string_view expected = ": expected [x, y, width, height] in pixels, none negative, width and height at least 1, nothing beyond 32768";
        const auto* node = need(table, key, "[x, y, width, height]", false);
        if (!node) return {};
        const auto* array = node->as_array();
        std::array<std::int64_t, 4> v{};
        bool good = array && array->size() == v.size();
        for (std::size_t i = 0; good && i < v.size(); ++i) {
            const auto* value = array->get(i)->as_integer();
            good = value && value->get() >= (i < 2 ? 0 : 1) && value->get() <= kMaxCanvas;
            if (good) v[i] = value->get();
        }
        good = good && v[0] + v[2] <= kMaxCanvas && v[1] + v[3] <= kMaxCanvas;
        if (!good) refuse(node->source(), quoted(key) + std::string(expected));
        return {int(v[0]), int(v[1]), int(v[2]), int(v[3])};
    }

    /// The tables of `[[key]]`.
    std::vector<const toml::table*> tables(const toml::table& parent, std::string_view key, std::string_view name) {
        const auto* node = need(parent, key, "at least one " + std::string(name), false);
        std::vector<const toml::table*> out;
        const auto* array = node ? node->as_array() : nullptr;
        for (std::size_t i = 0; array && i < array->size(); ++i) {
            if (const auto* table = array->get(i)->as_table()) out.push_back(table);
        }
        if (node && (out.empty() || out.size() != array->size())) refuse(node->source(), quoted(key) + ": expected " + std::string(name) + " tables");
        return out;
    }

    /// A table that may be absent; empty then.
    const toml::table& section(const toml::table& parent, std::string_view key) {
        static const toml::table nothing;
        const auto* node = parent.get(key);
        if (!node) return nothing;
        if (const auto* table = node->as_table()) return *table;
        refuse(node->source(), quoted(key) + ": expected a [" + std::string(key) + "] table");
        return nothing;
    }

    static std::string quoted(std::string_view key) { return "'" + std::string(key) + "'"; }

private:
    const toml::node* need(const toml::table& table, std::string_view key, std::string_view expected, bool optional) {
        const auto* node = table.get(key);
        if (!node && !optional) refuse(table.source(), quoted(key) + " is missing: expected " + std::string(expected));
        return node;
    }

    std::string file_;
    std::optional<Error> error_;
};

std::uint32_t read_background(TreeReader& read, const toml::table& wall) {
    const auto text = read.text(wall, "background", "#000000");
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    if (text.size() == 7 && text[0] == '#' && std::from_chars(text.data() + 1, end, value, 16).ptr == end) return value;
    read.refuse(wall.get("background") ? wall.get("background")->source() : wall.source(), "'background': expected a colour as \"#RRGGBB\"");
    return 0;
}

std::uint32_t read_user(TreeReader& read, const toml::node& node) {
    if (const auto* uid = node.as_integer(); uid && uid->get() >= 0 && uid->get() < UINT32_MAX) return static_cast<std::uint32_t>(uid->get());
    if (const auto* name = node.as_string()) {
        if (const passwd* entry = ::getpwnam(from_private_use(name->get()).c_str())) return entry->pw_uid;
        read.refuse(node.source(), "'users': this machine has no user '" + name->get() + "'");
        return 0;
    }
    read.refuse(node.source(), "'users': expected user names or numbers");
    return 0;
}

void read_control(TreeReader& read, const toml::table& root, WallConfig& out) {
    const auto& control = read.section(root, "control");
    read.only(control, "[control]", {"listen", "users"});
    if (const auto* listen = control.get("listen")) {
        const auto* array = listen->as_array();
        if (!array || array->empty()) read.refuse(listen->source(), "'listen': expected an array of addresses, unix:PATH or HOST:PORT");
        for (std::size_t i = 0; array && i < array->size(); ++i) out.control_listen.push_back(read.address(*array->get(i), "'listen'"));
    } else {
        out.control_listen.push_back({.path = {}, .host = "127.0.0.1", .port = net::kDefaultControlPort});
    }
    if (const auto* users = control.get("users")) {
        const auto* array = users->as_array();
        if (!array) read.refuse(users->source(), "'users': expected an array of user names or numbers");
        for (std::size_t i = 0; array && i < array->size(); ++i) out.allowed_users.push_back(read_user(read, *array->get(i)));
    }
}

void read_http(TreeReader& read, const toml::table& root, WallConfig& out) {
    const auto* node = root.get("http");
    if (!node) return;
    const auto& http = read.section(root, "http");
    read.only(http, "[http]", {"listen"});
    const auto* listen = http.get("listen");
    out.http_listen = listen ? read.address(*listen, "'listen'") : net::Address{.path = {}, .host = "127.0.0.1", .port = net::kDefaultHttpPort};
    if (listen && out.http_listen->is_unix()) read.refuse(listen->source(), "'listen' of [http]: expected HOST:PORT");
}

TileConfig read_tile(TreeReader& read, const toml::table& table) {
    read.only(table, "[[node.tile]]", {"name", "rect"});
    return {read.text(table, "name"), read.rect(table, "rect")};
}

NodeConfig read_node(TreeReader& read, const toml::table& table) {
    read.only(table, "[[node]]", {"name", "backend", "listen", "tile"});
    NodeConfig out;
    out.name = read.text(table, "name");
    const auto backend = read.text(table, "backend", "egl");
    const auto found = std::ranges::find(kBackends, backend, name_of);
    if (found != kBackends.end()) out.backend = *found;
    else read.refuse(table.get("backend")->source(), "'backend' is '" + backend + "': expected \"egl\" or \"osmesa\"");
    if (const auto* listen = table.get("listen")) out.listen = read.address(*listen, "'listen'");
    else out.listen = {.path = {}, .host = "127.0.0.1", .port = net::kDefaultDataPort};
    const auto tiles = read.tables(table, "tile", "[[node.tile]]");
    if (tiles.size() >= wire::kOffscreenSlot) {
        read.refuse(table.source(), "node '" + out.name + "' has " + std::to_string(tiles.size()) + " tiles: expected at most " + std::to_string(wire::kOffscreenSlot - 1));
    }
    for (const auto* tile : tiles) out.tiles.push_back(read_tile(read, *tile));
    return out;
}

/// Names must be unique: they are how people and daemons point at things.
void read_nodes(TreeReader& read, const toml::table& root, WallConfig& out) {
    std::set<std::string> nodes, tiles;
    for (const auto* table : read.tables(root, "node", "[[node]]")) {
        out.nodes.push_back(read_node(read, *table));
        const auto& node = out.nodes.back();
        if (!nodes.insert(node.name).second) read.refuse(table->source(), "node '" + node.name + "' appears twice: expected unique names");
        for (const auto& tile : node.tiles) {
            if (!tiles.insert(tile.name).second) read.refuse(table->source(), "tile '" + tile.name + "' appears twice: expected unique names");
        }
    }
}

}  // namespace

const char* name_of(Backend backend) { return backend == Backend::egl ? "egl" : "osmesa"; }

geom::Rect WallConfig::canvas() const {
    geom::Rect out;
    for (const auto& node : nodes) {
        for (const auto& tile : node.tiles) {
            out.width = std::max(out.width, tile.rect.right());
            out.height = std::max(out.height, tile.rect.bottom());
        }
    }
    return out;
}

const NodeConfig* WallConfig::find_node(std::string_view node) const {
    const auto found = std::ranges::find(nodes, node, &NodeConfig::name);
    return found == nodes.end() ? nullptr : &*found;
}

Result<WallConfig> parse_config(std::string_view toml, std::string_view file_name) {
    const auto parsed = toml::parse(to_private_use(toml), file_name);
    TreeReader read(file_name);
    if (!parsed) {
        read.refuse(parsed.error().source(), "not TOML: " + std::string(parsed.error().description()));
        return tl::unexpected(*read.error());
    }
    const toml::table& root = parsed.table();
    WallConfig out;
    read.only(root, "the file", {"wall", "control", "http", "node"});
    const auto& wall = read.section(root, "wall");
    read.only(wall, "[wall]", {"name", "background", "swap_timeout_ms"});
    out.name = read.text(wall, "name", "wall");
    out.background = read_background(read, wall);
    out.swap_timeout = std::chrono::milliseconds(read.integer(wall, "swap_timeout_ms", 1, kMaxSwapTimeout, out.swap_timeout.count()));
    read_control(read, root, out);
    read_http(read, root, out);
    read_nodes(read, root, out);
    if (read.error()) return tl::unexpected(*read.error());
    return out;
}

Result<WallConfig> load_config(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return fail(path + ": cannot be read: expected a wall description (docs/operation.md)");
    std::ostringstream text;
    text << file.rdbuf();
    return parse_config(text.str(), path);
}

}  // namespace wall::config
