// SPDX-License-Identifier: MIT
#include "tools/wallctl/tables.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/wallctl/cells.h"
#include "tools/wallctl/columns.h"

namespace wall::wallctl {
namespace {

using nlohmann::json;

/// "march", of a parallel program "march x3/4": processes that are there, and all.
std::string program(const json& session) {
    const auto group = session.find("group");
    if (group == session.end()) return text(session, "program");
    const auto members = group->value("members", json::array());
    const auto here =
        std::count_if(members.begin(), members.end(), [](const json& member) { return !is(member, "left"); });
    return fmt::format("{} x{}/{}", text(session, "program"), here, text(*group, "size"));
}

/// What its objects take on the node where it has most.
std::string memory(const json& session) {
    return fmt::format("{:.1f} MB", static_cast<double>(session.value("memory_bytes", std::uint64_t{0})) / 1e6);
}

/// Of a whole session, such as "held, stereo 1.5 %".
std::vector<std::string> notes(const json& session) {
    std::vector<std::string> out;
    if (is(session, "held")) out.push_back("held");
    else if (is(session, "silent")) out.push_back("silent");
    else if (auto fault = text(session, "fault"); !fault.empty()) out.push_back(std::move(fault));
    if (const auto stereo = session.find("stereo"); stereo != session.end() && stereo->is_object()) {
        const auto distance = stereo->value("distance", 0.0);
        out.push_back(fmt::format("stereo {:.3g} %", stereo->value("separation", 0.0)) +
                      (distance > 0 ? fmt::format(" at {:.6g}", distance) : ""));
    }
    return out;
}

void add_session(std::vector<Row>& rows, const json& session) {
    const auto of_all = notes(session);
    const auto note = fmt::format("{}", fmt::join(of_all, ", "));
    const auto with_views = [&](const json& surface) {
        const bool flat = text(surface, "views") == "flat";
        return !flat ? note : note.empty() ? "shown flat: its camera is not known" : note + ", flat";
    };
    const auto owner = who(session.value("owner", json::object()));
    const auto surfaces = session.value("surfaces", json::array());
    if (surfaces.empty())
        rows.push_back({text(session, "id"), program(session), text(session, "name"), owner, text(session, "pid"), "",
                        "", "", "", memory(session), note});
    for (const auto& s : surfaces) {
        rows.push_back({text(s, "id"), program(session), text(session, "name"), owner, text(session, "pid"),
                        fmt::format("{}x{}", text(s, "width"), text(s, "height")), place(s), text(s, "frame"),
                        traffic(session), memory(session), with_views(s)});
    }
}

/// "3 ring, 1 tls".
std::string transports(const json& node) {
    std::vector<std::string> out;
    const json open = node.value("transports", json::object());
    for (const auto& [transport, streams] : open.items())
        out.push_back(fmt::format("{} {}", streams.get<int>(), transport));
    return fmt::format("{}", fmt::join(out, ", "));
}

std::string pixels(const json& tile) {
    const json size = tile.value("pixels", json::array());
    return size.size() == 2 ? fmt::format("{}x{}", size[0].dump(), size[1].dump()) : "";
}

/// Where a tile looks, such as "looks 90 right".
std::string look(const json& view) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    constexpr std::size_t kAhead = 6;
    const auto at = [&](std::size_t i) { return view.at(kAhead + i).get<double>(); };
    const auto aside = std::lround(std::atan2(at(0), at(2)) * kDegrees);
    const auto up = std::lround(std::atan2(at(1), std::hypot(at(0), at(2))) * kDegrees);
    std::string out;
    if (aside != 0) out = fmt::format("{} {}", std::abs(aside), aside > 0 ? "right" : "left");
    if (up != 0) out += fmt::format("{}{} {}", out.empty() ? "" : " ", std::abs(up), up > 0 ? "up" : "down");
    return "looks " + (out.empty() ? "ahead" : out);
}

/// What its output does to the canvas's pixels, such as "turned 90, warp".
std::string shown(const json& tile) {
    std::string out;
    if (const auto turned = tile.value("rotation", 0); turned != 0) out = fmt::format("turned {}", turned);
    const json steps = tile.value("shown", json::array());
    for (const json& step : steps) out += (out.empty() ? "" : ", ") + step.get<std::string>();
    const auto add = [&](const std::string& step) { out += (out.empty() ? "" : ", ") + step; };
    if (const auto stereo = tile.value("stereo", ""); !stereo.empty()) add("both eyes, " + stereo);
    else if (tile.contains("eye") && tile["eye"].is_string()) add(tile["eye"].get<std::string>() + " eye");
    if (tile.contains("view") && tile["view"].is_array()) out += (out.empty() ? "" : ", ") + look(tile["view"]);
    return out.empty() ? "as it is" : out;
}

}  // namespace

std::string nodes_table(const json& nodes) {
    std::vector<Row> rows{
        {"NODE", "STATE", "BACKEND", "ADDRESS", "PID", "TILES", "FRAMES", "RECEIVED", "STREAMS", "RENDERER"}};
    for (const auto& n : nodes) {
        const auto* state = is(n, "drained") ? "drained" : is(n, "silent") ? "silent" : is(n, "up") ? "up" : "away";
        rows.push_back({text(n, "name"), state, text(n, "backend"), text(n, "address"), text(n, "pid"),
                        text(n, "tiles"), text(n, "frames"),
                        fmt::format("{:.1f} MB", n.value("bytes_received", 0.0) / 1e6), transports(n),
                        text(n, "renderer")});
    }
    return table(rows);
}

std::string tiles_table(const json& tiles) {
    std::vector<Row> rows{{"TILE", "NODE", "PLACE", "OUTPUT", "PIXELS", "SHOWN", "STATE"}};
    for (const auto& t : tiles)
        rows.push_back({text(t, "name"), text(t, "node"), place(t), text(t, "output"), pixels(t), shown(t),
                        is(t, "up") ? "up" : "away"});
    return table(rows);
}

std::string sessions_table(const json& sessions) {
    std::vector<Row> rows{
        {"ID", "PROGRAM", "NAME", "OWNER", "PID", "WINDOW", "PLACE", "FRAME", "SENT", "MEMORY", "NOTE"}};
    for (const auto& session : sessions) add_session(rows, session);
    return table(rows);
}

std::string streams_table(const json& streams) {
    std::vector<Row> rows{
        {"TILE", "NODE", "REGION", "ONLY", "CODEC", "SIZE", "FPS", "VIEWERS", "FRAMES", "DROPPED", "RECEIVED"}};
    for (const auto& s : streams) {
        rows.push_back({text(s, "tile"), text(s, "node"), text(s, "region"), text(s, "session"), text(s, "codec"),
                        text(s, "width") + "x" + text(s, "height"), text(s, "fps"), text(s, "viewers"),
                        text(s, "frames"), text(s, "dropped"), fmt::format("{:.1f} MB", s.value("bytes", 0.0) / 1e6)});
    }
    return table(rows);
}

std::string machines_table(const json& machines) {
    std::vector<Row> rows{{"KIND", "NAME", "ROLE", "STATE", "KEY"}};
    for (const auto& m : machines)
        rows.push_back(
            {text(m, "kind"), text(m, "name"), text(m, "role"), is(m, "up") ? "up" : "away", text(m, "key")});
    return table(rows);
}

std::string tokens_table(const json& tokens) {
    std::vector<Row> rows{{"NAME", "ROLE", "STATE", "PROGRAMS"}};
    for (const auto& t : tokens)
        rows.push_back({text(t, "name"), text(t, "role"), is(t, "revoked") ? "revoked" : "good", text(t, "programs")});
    return table(rows);
}

std::string revoked_text(const json& revoked) {
    const auto programs = revoked.value("ended", 0);
    return fmt::format("revoked; {} ended\n", programs == 1 ? "1 program" : std::to_string(programs) + " programs");
}

std::string invitation_text(const json& invitation) {
    return fmt::format("run this on that machine within {} minutes; it is good once:\n\n  {}\n",
                       invitation.value("valid_s", 0) / 60, text(invitation, "command"));
}

/// Where the status page is, and how a browser knows that it is ours.
std::string page_text(const json& status) {
    const auto page = status.value("page", json::object());
    std::string out;
    for (const auto& url : page.value("urls", std::vector<std::string>())) {
        out += "page: " + url;
        if (url.starts_with("https")) out += "  certificate (SHA-256): " + text(page, "certificate");
        out += '\n';
    }
    return out;
}

std::string status_text(const json& status) {
    const auto& wall = status.at("wall");
    const auto& nodes = status.at("nodes");
    const auto up = std::ranges::count_if(nodes, [](const json& n) { return is(n, "up"); });
    return fmt::format("wall {}: {}x{} pixels, {} tiles, {} of {} nodes up, {} programs\n{}\n{}\n{}",
                       text(wall, "name"), text(wall, "width"), text(wall, "height"), status.at("tiles").size(), up,
                       nodes.size(), status.at("sessions").size(), page_text(status), nodes_table(nodes),
                       sessions_table(status.at("sessions")));
}

std::string person_text(const json& person) { return fmt::format("{}, role {}\n", who(person), text(person, "role")); }

std::string names_text(const json& names) {
    std::string out;
    for (const auto& name : names) out += name.get<std::string>() + "\n";
    return out;
}

std::string reloaded_text(const json& reloaded) {
    std::string names;
    for (const auto& name : reloaded.at("nodes")) names += " " + name.get<std::string>();
    return fmt::format("the wall has {} tiles; nodes that are new, gone or described otherwise:{}\n",
                       text(reloaded, "tiles"), names.empty() ? " none" : names);
}

std::string placed_text(const json& loaded) {
    return fmt::format("{} windows placed, {} places wait for programs\n", text(loaded, "placed"),
                       text(loaded, "waiting"));
}

}  // namespace wall::wallctl
