// SPDX-License-Identifier: MIT
#include "tools/wallctl/tables.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace wall::wallctl {
namespace {

using nlohmann::json;
using Row = std::vector<std::string>;

/// Columns as wide as their widest cell, two blanks between them.
std::string table(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string out;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
        out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return out;
}

std::string text(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || found->is_null()) return "";
    return found->is_string() ? found->get<std::string>() : found->dump();
}

std::string place(const json& object) {
    const auto rect = object.value("rect", std::vector<int>(4));
    return rect.size() == 4 ? fmt::format("{}x{}+{}+{}", rect[2], rect[3], rect[0], rect[1]) : "";
}

bool is(const json& object, const char* key) { return object.value(key, false); }

std::string who(const json& person) {
    const auto kind = text(person, "kind");
    if (kind == "unknown") return "unknown";
    return kind == "token" ? "token " + text(person, "name") : text(person, "name");
}

/// Bytes a second to all nodes; empty before the program has said anything.
std::string traffic(const json& session) {
    const auto of = session.value("traffic", json::object());
    if (of.value("frames", 0) == 0 && of.value("geometry_bytes", 0) == 0) return "";
    const double bytes = of.value("state_bytes_per_second", 0.0) + of.value("object_bytes_per_second", 0.0) + of.value("geometry_bytes_per_second", 0.0);
    return fmt::format("{:.1f} kB/s", bytes / 1e3);
}

void add_session(std::vector<Row>& rows, const json& session) {
    const auto note = is(session, "held") ? "held" : text(session, "fault");
    const auto owner = who(session.value("owner", json::object()));
    const auto surfaces = session.value("surfaces", json::array());
    if (surfaces.empty()) rows.push_back({text(session, "id"), text(session, "program"), text(session, "name"), owner, text(session, "pid"), "", "", "", "", note});
    for (const auto& s : surfaces) {
        rows.push_back({text(s, "id"), text(session, "program"), text(session, "name"), owner, text(session, "pid"),
                        fmt::format("{}x{}", text(s, "width"), text(s, "height")), place(s), text(s, "frame"), traffic(session), note});
    }
}

}  // namespace

std::string nodes_table(const json& nodes) {
    std::vector<Row> rows{{"NODE", "STATE", "BACKEND", "ADDRESS", "PID", "TILES", "FRAMES", "RECEIVED", "RENDERER"}};
    for (const auto& n : nodes) {
        rows.push_back({text(n, "name"), is(n, "up") ? "up" : "away", text(n, "backend"), text(n, "address"), text(n, "pid"), text(n, "tiles"),
                        text(n, "frames"), fmt::format("{:.1f} MB", n.value("bytes_received", 0.0) / 1e6), text(n, "renderer")});
    }
    return table(rows);
}

std::string tiles_table(const json& tiles) {
    std::vector<Row> rows{{"TILE", "NODE", "PLACE", "STATE"}};
    for (const auto& t : tiles) rows.push_back({text(t, "name"), text(t, "node"), place(t), is(t, "up") ? "up" : "away"});
    return table(rows);
}

std::string sessions_table(const json& sessions) {
    std::vector<Row> rows{{"ID", "PROGRAM", "NAME", "OWNER", "PID", "WINDOW", "PLACE", "FRAME", "SENT", "NOTE"}};
    for (const auto& session : sessions) add_session(rows, session);
    return table(rows);
}

std::string status_text(const json& status) {
    const auto& wall = status.at("wall");
    const auto& nodes = status.at("nodes");
    const auto up = std::ranges::count_if(nodes, [](const json& n) { return is(n, "up"); });
    return fmt::format("wall {}: {}x{} pixels, {} tiles, {} of {} nodes up, {} programs\n\n{}\n{}", text(wall, "name"), text(wall, "width"),
                       text(wall, "height"), status.at("tiles").size(), up, nodes.size(), status.at("sessions").size(), nodes_table(nodes),
                       sessions_table(status.at("sessions")));
}

std::string person_text(const json& person) { return fmt::format("{}, role {}\n", who(person), text(person, "role")); }

std::string names_text(const json& names) {
    std::string out;
    for (const auto& name : names) out += name.get<std::string>() + "\n";
    return out;
}

std::string placed_text(const json& loaded) { return fmt::format("{} windows placed, {} places wait for programs\n", text(loaded, "placed"), text(loaded, "waiting")); }

}  // namespace wall::wallctl
