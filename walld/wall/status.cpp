// SPDX-License-Identifier: MIT
#include "walld/wall/status.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "walld/wall/session_stats.h"

namespace wall::walld {
namespace {

using nlohmann::json;

json rect_json(const geom::Rect& rect) { return {rect.x, rect.y, rect.width, rect.height}; }

std::string color_text(std::uint32_t rgb) { return fmt::format("#{:06x}", rgb); }

json spread_json(const Spread& spread) {
    const auto ms = [](Spread::Milliseconds value) { return std::round(value.count() * 1000) / 1000; };
    return {{"frames", spread.frames()},
            {"last_ms", ms(spread.last())},
            {"mean_ms", ms(spread.mean())},
            {"most_ms", ms(spread.most())}};
}

json views_json(SurfaceEntry::Views views) {
    if (views == SurfaceEntry::Views::none) return nullptr;
    return views == SurfaceEntry::Views::seen ? "seen" : "flat";
}

json native_json(const std::optional<proto::NativeWindow>& window) {
    if (!window) return nullptr;
    return {{"display", window->display()}, {"id", window->id()}};
}

json surface_json(const Wall& wall, const SurfaceKey& key) {
    const auto& surface = *wall.find(key);
    const auto& stacking = wall.stacking();
    return {{"id", fmt::format("{}.{}", key.session.value, key.surface.value)},
            {"title", surface.title},
            {"x_window", native_json(surface.native)},
            {"width", surface.width},
            {"height", surface.height},
            {"rect", rect_json(surface.place.wanted())},
            {"shown_rect", rect_json(surface.place.shown())},
            {"moving", surface.place.moving()},
            {"scaled", surface.scaled},
            {"views", views_json(surface.views)},
            {"z", std::ranges::find(stacking, key) - stacking.begin()},
            {"frame", surface.swap.presented()},
            {"held", surface.swap.held()},
            {"swap_timeouts", surface.swap.timeouts()},
            {"frame_interval_ms", std::round(surface.swap.frame_interval().count() * 1000) / 1000},
            {"skew",
             {{"rendered", spread_json(surface.swap.rendered_spread())},
              {"presented", spread_json(surface.swap.presented_spread())}}}};
}

json objects_json(const proto::DriverObjects& o) {
    return {{"textures", o.textures()},           {"buffers", o.buffers()}, {"lists", o.lists()},
            {"programs", o.programs()},           {"shaders", o.shaders()}, {"framebuffers", o.framebuffers()},
            {"renderbuffers", o.renderbuffers()}, {"queries", o.queries()}};
}

json transports_json(const proto::NodeStats& stats) {
    json out = json::object();
    for (const auto& transport : stats.transports()) out[transport.name()] = transport.streams();
    return out;
}

json node_json(const Node& node) {
    return {{"name", node.config->name},
            {"process", node.config->process},
            {"gpu", node.config->gpu()},
            {"up", node.up},
            {"silent", node.silent},
            {"drained", node.duty == Duty::drained},
            {"backend", node.up ? node.hello.backend() : config::name_of(node.config->backend)},
            {"address", node.up ? node.hello.address() : node.config->listen.text()},
            {"pid", node.hello.pid()},
            {"incarnation", node.incarnation},
            {"renderer", node.hello.caps().renderer()},
            {"version", node.hello.caps().version()},
            {"tiles", node.config->tiles.size()},
            {"frames", node.stats.frames()},
            {"bytes_received", node.stats.bytes_received()},
            {"bytes_handed_on", node.stats.bytes_handed_on()},
            {"commands", node.stats.commands()},
            {"gl_errors", node.stats.gl_errors()},
            {"array_elements", node.stats.array_elements()},
            {"clock_ahead_ms", node.up && node.clock_ahead ? json(node.clock_ahead->count()) : json(nullptr)},
            {"transports", node.up ? transports_json(node.stats) : json::object()},
            {"objects", objects_json(node.stats.objects())}};
}

json traffic_json(const SessionTraffic& traffic) {
    const auto& sent = traffic.sent();
    const auto& rates = traffic.rates();
    return {{"frames", traffic.frames()},
            {"round_trips", traffic.round_trips()},
            {"lossy_vertices", traffic.lossy_vertices()},
            {"diff_seconds", traffic.diff_seconds()},
            {"state_bytes", sent.state},
            {"object_bytes", sent.object},
            {"geometry_bytes", sent.geometry},
            {"link_bytes", sent.link},
            {"state_bytes_per_second", std::round(rates.state)},
            {"object_bytes_per_second", std::round(rates.object)},
            {"geometry_bytes_per_second", std::round(rates.geometry)},
            {"link_bytes_per_second", std::round(rates.link)},
            {"frame_bytes", std::round(rates.frame_bytes)}};
}

json pattern_json(const Wall& wall, const std::string& tile) {
    const auto found = wall.patterns().find(tile);
    if (found == wall.patterns().end()) return nullptr;
    auto name = proto::TilePattern::Kind_Name(found->second.kind());
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name;
}

/// What is done to the canvas's pixels, beside turning and scaling them.
json steps_json(const geom::TileOutput& output) {
    json out = json::array();
    if (output.warp) out.push_back("warp");
    if (output.blend) out.push_back("blend");
    if (output.color) out.push_back("color");
    return out;
}

/// "left", "right"; null: both.
json eye_json(geom::Eye eye) {
    if (eye == geom::Eye::both) return nullptr;
    return eye == geom::Eye::left ? "left" : "right";
}

/// As the verb `stereo` takes it; null: both eyes see the same.
json stereo_json(const std::optional<proto::Stereo>& stereo) {
    if (!stereo) return nullptr;
    return {{"separation", 100 * static_cast<double>(stereo->separation())}, {"distance", stereo->screen()}};
}

/// What wall.toml says, in bytes.
json quota_json(const config::QuotaConfig& quota) {
    json out = json::object();
    const auto add = [&](const char* name, const auto& value) {
        if (value) out[name] = *value;
    };
    add("program_memory", quota.program_memory);
    add("program_objects", quota.program_objects);
    add("program_bandwidth", quota.program_bandwidth);
    add("program_fps", quota.program_fps);
    add("program_windows", quota.program_windows);
    add("person_programs", quota.person_programs);
    add("person_memory", quota.person_memory);
    add("person_views", quota.person_views);
    add("person_pictures", quota.person_pictures);
    return out;
}

json load_json(const Node& node, std::uint32_t slot) {
    const auto found = node.times.loads.find(slot);
    return found == node.times.loads.end() ? json(nullptr) : json(std::round(found->second * 1000) / 1000);
}

}  // namespace

json nodes_json(const Wall& wall) {
    auto out = json::array();
    for (const auto& node : wall.nodes())
        if (node.duty != Duty::gone) out.push_back(node_json(node));
    return out;
}

json tiles_json(const Wall& wall, Clock::time_point now) {
    auto out = json::array();
    for (const NodeIndex i : wall.nodes().ids()) {
        const auto& node = wall.nodes()[i];
        for (const auto& tile : node.config->tiles) {
            if (tile.arriving) continue;
            const auto shown = node.shown_in(tile.slot);
            const auto age =
                shown.last ? json(std::chrono::duration_cast<std::chrono::milliseconds>(now - *shown.last).count())
                           : json(nullptr);
            json view = nullptr;
            if (tile.view) view = geom::values_of(*tile.view);
            out.push_back({{"name", tile.name},
                           {"node", node.config->name},
                           {"slot", tile.slot},
                           {"rect", rect_json(tile.rect)},
                           {"output", config::output_name(tile)},
                           {"pixels", {tile.output.width, tile.output.height}},
                           {"rotation", tile.output.rotation},
                           {"shown", steps_json(tile.output)},
                           {"view", std::move(view)},
                           {"eye", eye_json(tile.eye)},
                           {"stereo", geom::name_of(tile.output.stereo)},
                           {"pattern", pattern_json(wall, tile.name)},
                           {"up", node.up},
                           {"frames", shown.frames},
                           {"age_ms", age},
                           {"lag_frames", wall.tile_lag(i, tile)},
                           {"load", load_json(node, tile.slot)}});
        }
    }
    return out;
}

/// Of a parallel program.
json group_json(const ParallelGroup& group) {
    auto members = json::array();
    for (const auto& [rank, member] : group.members())
        members.push_back({{"rank", rank}, {"pid", member.pid}, {"left", member.left}});
    return {{"name", group.name()}, {"size", group.size()}, {"members", std::move(members)}};
}

static json session_json(const Wall& wall, SessionId id, const std::map<SessionId, HeldOnNodes>& most) {
    const auto& session = wall.sessions().at(id);
    const auto found = most.find(id);
    const auto held = found == most.end() ? HeldOnNodes() : found->second;
    auto surfaces = json::array();
    for (const auto& key : wall.stacking()) {
        if (key.session == id) surfaces.push_back(surface_json(wall, key));
    }
    json out{{"id", id.value},
             {"pid", session.pid},
             {"program", session.program},
             {"name", session.name},
             {"owner", person_json(session.owner)},
             {"held", session.held},
             {"fault", session.fault},
             {"silent", session.silent},
             {"recorded", session.recorder.has_value()},
             {"weight", session.weight},
             {"stereo", stereo_json(session.stereo)},
             {"sort_last", session.sort_last},
             {"lossy_pixels", session.lossy_pixels},
             {"partials",
              {{"bytes", held.partials.bytes},
               {"merged", held.partials.merged},
               {"missed", held.partials.missed},
               {"seconds", held.partials.seconds},
               {"wait_seconds", held.partials.wait_seconds}}},
             {"memory_bytes", held.memory_bytes},
             {"objects", held.objects},
             {"traffic", traffic_json(session.traffic)},
             {"surfaces", std::move(surfaces)}};
    if (session.group) out["group"] = group_json(*session.group);
    return out;
}

json session_json(const Wall& wall, SessionId id) { return session_json(wall, id, held_on_nodes(wall)); }

json sessions_json(const Wall& wall) {
    auto out = json::array();
    const auto most = held_on_nodes(wall);
    for (const auto& [id, session] : wall.sessions()) out.push_back(session_json(wall, id, most));
    return out;
}

json person_json(const Person& person) {
    constexpr const char* kKinds[] = {"user", "token", "host_user", "machine", "unknown"};  // in the order of Kind
    return {
        {"kind", kKinds[static_cast<int>(person.kind)]}, {"name", person.name}, {"role", config::name_of(person.role)}};
}

json status_json(const Wall& wall, Clock::time_point now) {
    const auto canvas = wall.config().canvas();
    return {{"wall",
             {{"name", wall.config().name},
              {"width", canvas.width},
              {"height", canvas.height},
              {"background", color_text(wall.config().background)},
              {"max_sessions", wall.config().max_sessions},
              {"quota", quota_json(wall.config().quota)}}},
            {"nodes", nodes_json(wall)},
            {"tiles", tiles_json(wall, now)},
            {"sessions", sessions_json(wall)}};
}

std::string dump(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace wall::walld
