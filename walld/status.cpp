// SPDX-License-Identifier: MIT
#include "walld/status.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace wall::walld {
namespace {

using nlohmann::json;

json rect_json(const geom::Rect& rect) { return {rect.x, rect.y, rect.width, rect.height}; }

std::string color_text(std::uint32_t rgb) { return fmt::format("#{:06x}", rgb); }

json spread_json(const Spread& spread) {
    const auto ms = [](Spread::Milliseconds value) { return std::round(value.count() * 1000) / 1000; };
    return {{"frames", spread.frames()}, {"last_ms", ms(spread.last())}, {"mean_ms", ms(spread.mean())}, {"most_ms", ms(spread.most())}};
}

json surface_json(const Wall& wall, const SurfaceKey& key) {
    const auto& surface = *wall.find(key);
    const auto& stacking = wall.stacking();
    return {{"id", fmt::format("{}.{}", key.session.value, key.surface.value)},
            {"title", surface.title},
            {"width", surface.width},
            {"height", surface.height},
            {"rect", rect_json(surface.place.wanted())},
            {"shown_rect", rect_json(surface.place.shown())},
            {"moving", surface.place.moving()},
            {"scaled", surface.scaled},
            {"z", std::ranges::find(stacking, key) - stacking.begin()},
            {"frame", surface.swap.presented()},
            {"held", surface.swap.held()},
            {"swap_timeouts", surface.swap.timeouts()},
            {"frame_interval_ms", std::round(surface.swap.frame_interval().count() * 1000) / 1000},
            {"skew", {{"rendered", spread_json(surface.swap.rendered_spread())}, {"presented", spread_json(surface.swap.presented_spread())}}}};
}

json node_json(const Node& node) {
    return {{"name", node.config->name},
            {"up", node.up},
            {"backend", node.up ? node.hello.backend() : config::name_of(node.config->backend)},
            {"address", node.up ? node.hello.address() : node.config->listen.text()},
            {"pid", node.hello.pid()},
            {"incarnation", node.incarnation},
            {"renderer", node.hello.caps().renderer()},
            {"version", node.hello.caps().version()},
            {"tiles", node.config->tiles.size()},
            {"frames", node.stats.frames()},
            {"bytes_received", node.stats.bytes_received()},
            {"commands", node.stats.commands()},
            {"gl_errors", node.stats.gl_errors()}};
}

/// A number for every node, as Prometheus wants it.
template <class Value>
void per_node(std::string& out, const Wall& wall, const char* name, const char* type, Value&& value) {
    out += fmt::format("# TYPE {} {}\n", name, type);
    for (const auto& node : wall.nodes()) out += fmt::format("{}{{node={}}} {}\n", name, json(node.config->name).dump(), value(node));
}

/// The skew of every surface, in seconds.
void surface_skew(std::string& out, const Wall& wall) {
    out += "# TYPE wallgl_surface_rendered_skew_seconds gauge\n";
    for (const auto& key : wall.stacking()) {
        const auto mean = std::chrono::duration<double>(wall.find(key)->swap.rendered_spread().mean()).count();
        out += fmt::format("wallgl_surface_rendered_skew_seconds{{surface=\"{}.{}\"}} {:.6f}\n", key.session.value, key.surface.value, mean);
    }
}

void single(std::string& out, const char* name, const char* type, std::uint64_t value) { out += fmt::format("# TYPE {0} {1}\n{0} {2}\n", name, type, value); }

}  // namespace

json nodes_json(const Wall& wall) {
    auto out = json::array();
    for (const auto& node : wall.nodes()) out.push_back(node_json(node));
    return out;
}

json tiles_json(const Wall& wall) {
    auto out = json::array();
    for (const auto& node : wall.nodes()) {
        for (std::uint32_t slot = 0; const auto& tile : node.config->tiles) {
            out.push_back({{"name", tile.name}, {"node", node.config->name}, {"slot", slot++}, {"rect", rect_json(tile.rect)}, {"up", node.up}});
        }
    }
    return out;
}

json session_json(const Wall& wall, SessionId id) {
    const auto& session = wall.sessions().at(id);
    auto surfaces = json::array();
    for (const auto& key : wall.stacking()) {
        if (key.session == id) surfaces.push_back(surface_json(wall, key));
    }
    return {{"id", id.value}, {"pid", session.pid}, {"program", session.program}, {"name", session.name}, {"owner", person_json(session.owner)},
            {"held", session.held}, {"fault", session.fault}, {"surfaces", std::move(surfaces)}};
}

json sessions_json(const Wall& wall) {
    auto out = json::array();
    for (const auto& [id, session] : wall.sessions()) out.push_back(session_json(wall, id));
    return out;
}

json person_json(const Person& person) {
    constexpr const char* kKinds[] = {"user", "token", "unknown"};
    return {{"kind", kKinds[static_cast<int>(person.kind)]}, {"name", person.name}, {"role", config::name_of(person.role)}};
}

json status_json(const Wall& wall) {
    const auto canvas = wall.config().canvas();
    return {{"wall", {{"name", wall.config().name}, {"width", canvas.width}, {"height", canvas.height}, {"background", color_text(wall.config().background)}, {"max_sessions", wall.config().max_sessions}}},
            {"nodes", nodes_json(wall)},
            {"tiles", tiles_json(wall)},
            {"sessions", sessions_json(wall)}};
}

std::string dump(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string metrics_text(const Wall& wall) {
    std::string out;
    std::uint64_t surfaces = 0, timeouts = 0;
    for (const auto& [id, session] : wall.sessions()) {
        surfaces += session.surfaces.size();
        for (const auto& [surface_id, surface] : session.surfaces) timeouts += surface.swap.timeouts();
    }
    single(out, "wallgl_sessions", "gauge", wall.sessions().size());
    single(out, "wallgl_surfaces", "gauge", surfaces);
    single(out, "wallgl_sessions_opened_total", "counter", wall.counters().sessions);
    single(out, "wallgl_presents_total", "counter", wall.counters().presents);
    single(out, "wallgl_session_faults_total", "counter", wall.counters().faults);
    single(out, "wallgl_live_surfaces_swap_timeouts", "gauge", timeouts);
    surface_skew(out, wall);
    per_node(out, wall, "wallgl_node_up", "gauge", [](const Node& n) { return n.up ? 1 : 0; });
    per_node(out, wall, "wallgl_node_frames_total", "counter", [](const Node& n) { return n.stats.frames(); });
    per_node(out, wall, "wallgl_node_received_bytes_total", "counter", [](const Node& n) { return n.stats.bytes_received(); });
    per_node(out, wall, "wallgl_node_commands_total", "counter", [](const Node& n) { return n.stats.commands(); });
    per_node(out, wall, "wallgl_node_gl_errors_total", "counter", [](const Node& n) { return n.stats.gl_errors(); });
    return out;
}

}  // namespace wall::walld
