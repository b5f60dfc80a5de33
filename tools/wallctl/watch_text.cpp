// SPDX-License-Identifier: MIT
#include "tools/wallctl/watch_text.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/wallctl/cells.h"
#include "tools/wallctl/columns.h"

namespace wall::wallctl {
namespace {

using nlohmann::json;

/// What stays the same about a row from one status to the next.
std::string key_of(const json& row) {
    std::string out;
    for (const auto* member : {"id", "name", "node", "tile", "region", "session", "codec", "width", "height", "fps"})
        out += row.value(member, json()).dump() + " ";
    return out;
}

void rate(const json& before, json& now, const char* counter, const char* result, double seconds) {
    const double grown = now.value(counter, 0.0) - before.value(counter, 0.0);
    if (grown >= 0 && seconds > 0) now[result] = grown / seconds;  // less: it began anew
}

using Rate = void (*)(const json&, json&, double);

void rate_rows(const json& before, json& now, double seconds, Rate one) {
    std::map<std::string, const json*> old;
    for (const auto& row : before) old[key_of(row)] = &row;
    for (auto& row : now)
        if (const auto found = old.find(key_of(row)); found != old.end()) one(*found->second, row, seconds);
}

/// The surfaces of all sessions, by their own ids.
json surfaces_of(const json& status) {
    auto out = json::array();
    for (const auto& session : status.value("sessions", json::array()))
        for (const auto& surface : session.value("surfaces", json::array()))
            out.push_back({{"id", surface.at("id")}, {"frame", surface.at("frame")}});
    return out;
}

std::string fps(const json& row) {
    const auto found = row.find("frames_per_second");
    return found == row.end() ? "" : fmt::format("{:.1f}", found->get<double>());
}

std::string age(const json& tile) {
    const auto ms = tile.value("age_ms", json());
    return ms.is_null() ? "" : fmt::format("{:.1f} s", ms.get<double>() / 1000);
}

std::string tile_state(const json& tile) {
    if (!is(tile, "up")) return "away";
    const auto lag = tile.value("lag_frames", 0);
    return lag > 0 ? fmt::format("late {}", lag) : "up";
}

bool touch(const json& a, const json& b) {
    return a[0] < b[0].get<int>() + b[2].get<int>() && b[0] < a[0].get<int>() + a[2].get<int>() &&
           a[1] < b[1].get<int>() + b[3].get<int>() && b[1] < a[1].get<int>() + a[3].get<int>();
}

/// The greatest of the windows on the tile that were shown by several nodes.
std::string skew(const json& tile, const json& status) {
    std::string out;
    double most = -1;
    for (const auto& session : status.at("sessions")) {
        for (const auto& surface : session.at("surfaces")) {
            const auto& presented = surface.at("skew").at("presented");
            if (presented.at("frames") > 0 && touch(surface.at("shown_rect"), tile.at("rect")))
                most = std::max(most, presented.at("last_ms").get<double>());
        }
    }
    return most < 0 ? "" : fmt::format("{:.1f} ms", most);
}

std::vector<Row> tile_rows(const json& status) {
    std::vector<Row> rows{{"TILE", "STATE", "FPS", "AGE", "SKEW", "NODE", "PLACE"}};
    for (const auto& tile : status.at("tiles"))
        rows.push_back({text(tile, "name"), tile_state(tile), fps(tile), age(tile), skew(tile, status),
                        text(tile, "node"), place(tile)});
    return rows;
}
constexpr std::array kTileRanks{0, 0, 1, 2, 3, 4, 5};

std::vector<Row> session_rows(const json& status) {
    std::vector<Row> rows{{"ID", "PROGRAM", "OWNER", "FPS", "SENT", "PLACE", "NOTE"}};
    for (const auto& session : status.at("sessions")) {
        const auto name = text(session, "name").empty() ? text(session, "program") : text(session, "name");
        const auto owner = who(session.value("owner", json::object()));
        const auto note = is(session, "held") ? "held" : text(session, "fault");
        if (session.at("surfaces").empty())
            rows.push_back({text(session, "id"), name, owner, "", traffic(session), "", note});
        for (const auto& surface : session.at("surfaces"))
            rows.push_back({text(surface, "id"), name, owner, fps(surface), traffic(session), place(surface), note});
    }
    return rows;
}
constexpr std::array kSessionRanks{0, 0, 3, 1, 2, 5, 4};

std::vector<Row> stream_rows(const json& status) {
    std::vector<Row> rows{{"WATCHED", "SIZE", "FPS", "SENT", "DROPPED", "VIEWERS", "CODEC", "REGION", "ONLY"}};
    for (const auto& stream : status.value("streams", json::array())) {
        const auto bytes = stream.find("bytes_per_second");
        rows.push_back({text(stream, "tile"), text(stream, "width") + "x" + text(stream, "height"), fps(stream),
                        bytes == stream.end() ? "" : per_second(bytes->get<double>()), text(stream, "dropped"),
                        text(stream, "viewers"), text(stream, "codec"), text(stream, "region"),
                        text(stream, "session")});
    }
    return rows;
}
constexpr std::array kStreamRanks{0, 2, 1, 1, 4, 3, 5, 6, 7};

std::string head(const json& status) {
    const auto& wall = status.at("wall");
    const auto& nodes = status.at("nodes");
    const auto up = std::ranges::count_if(nodes, [](const json& node) { return is(node, "up"); });
    return fmt::format("wall {}: {}x{}, {} of {} nodes up, {} programs", text(wall, "name"), text(wall, "width"),
                       text(wall, "height"), up, nodes.size(), status.at("sessions").size());
}

/// The last line says how many are missing.
std::string fit_rows(const std::string& lines, std::size_t rows) {
    const auto count = static_cast<std::size_t>(std::ranges::count(lines, '\n'));
    if (count <= rows || rows == 0) return lines;
    std::size_t end = 0;
    for (std::size_t i = 0; i + 1 < rows; ++i) end = lines.find('\n', end) + 1;
    return lines.substr(0, end) + fmt::format("{} more lines\n", count - rows + 1);
}

}  // namespace

json with_rates(const json& before, json now, double seconds) {
    if (before.is_null()) return now;
    rate_rows(before.at("tiles"), now.at("tiles"), seconds,
              [](const json& b, json& n, double s) { rate(b, n, "frames", "frames_per_second", s); });
    rate_rows(before.value("streams", json::array()), now["streams"], seconds, [](const json& b, json& n, double s) {
        rate(b, n, "frames", "frames_per_second", s);
        rate(b, n, "bytes", "bytes_per_second", s);
    });
    for (auto& session : now.at("sessions"))
        for (auto& surface : session.at("surfaces"))
            for (const auto& old : surfaces_of(before))
                if (old.at("id") == surface.at("id")) rate(old, surface, "frame", "frames_per_second", seconds);
    return now;
}

std::string watch_text(const json& rated, const std::string& note, const Screen& screen) {
    const auto tiles = tile_rows(rated), sessions = session_rows(rated), streams = stream_rows(rated);
    std::string out = cut(head(rated) + (note.empty() ? "" : "  " + note), screen.columns) + "\n\n" +
                      table(tiles, kTileRanks, screen.columns);
    if (sessions.size() > 1) out += "\n" + table(sessions, kSessionRanks, screen.columns);
    if (streams.size() > 1) out += "\n" + table(streams, kStreamRanks, screen.columns);
    return fit_rows(out, screen.rows);
}

}  // namespace wall::wallctl
