// SPDX-License-Identifier: MIT
// Metrics of nodes and their tiles. A node that is away has only wallgl_node_up and wallgl_node_starts_total.
#include "walld/metrics/metrics.h"

namespace wall::walld {
namespace {

using enum prometheus::MetricType;
using NodeRef = const Node*;

constexpr MetricRow<NodeRef> kAlways[] = {
    {Gauge, "wallgl_node_up", "1 while the node's tileserver is connected, else 0.",
     [](const NodeRef& n) { return n->up ? 1.0 : 0.0; }},
    {Counter, "wallgl_node_starts_total", "Tileserver processes that walld has seen for this node.",
     [](const NodeRef& n) { return n->incarnation; }},
};

constexpr MetricRow<NodeRef> kNodeInfo[] = {
    {Gauge, "wallgl_node_info", "Always 1; what the node draws with.", [](const NodeRef&) { return 1.0; }},
};

std::uint64_t queued(const Node& node) {
    std::uint64_t bytes = 0;
    for (const auto& session : node.stats.session_stats()) bytes += session.queued_bytes();
    return bytes;
}

constexpr MetricRow<NodeRef> kWhileUp[] = {
    {Gauge, "wallgl_node_sessions", "Programs with a stream to the node.",
     [](const NodeRef& n) { return n->stats.sessions(); }},
    {Counter, "wallgl_node_frames_total", "Frames of windows drawn since the node started.",
     [](const NodeRef& n) { return n->stats.frames(); }},
    {Counter, "wallgl_node_received_bytes_total", "Bytes received from programs since the node started.",
     [](const NodeRef& n) { return n->stats.bytes_received(); }},
    {Counter, "wallgl_node_handed_on_bytes_total",
     "Bytes of what programs send to several nodes that the node has handed on to others, since it started.",
     [](const NodeRef& n) { return n->stats.bytes_handed_on(); }},
    {Counter, "wallgl_node_commands_total", "Commands executed since the node started.",
     [](const NodeRef& n) { return n->stats.commands(); }},
    {Counter, "wallgl_node_gl_errors_total", "OpenGL errors of the driver since the node started.",
     [](const NodeRef& n) { return n->stats.gl_errors(); }},
    {Counter, "wallgl_node_array_elements_total",
     "Elements of draws from buffers, as often as a tile drew them, since the node started.",
     [](const NodeRef& n) { return n->stats.array_elements(); }},
    {Counter, "wallgl_node_context_switches_total",
     "Blocks that found another program's context in the driver, since the node started.",
     [](const NodeRef& n) { return n->stats.context_switches(); }},
    {Counter, "wallgl_node_decode_seconds_total",
     "Time of the render thread in taking batches apart and calling the driver, since the node started.",
     [](const NodeRef& n) { return seconds(n->stats.decode_ns()); }},
    {Counter, "wallgl_node_render_seconds_total",
     "Time of the render thread in waiting for the driver to end frames and answers, since the node started.",
     [](const NodeRef& n) { return seconds(n->stats.render_ns()); }},
    {Gauge, "wallgl_node_queue_bytes", "Bytes that programs have sent and that are not executed yet.",
     [](const NodeRef& n) { return queued(*n); }},
};

using Count = std::uint64_t;
constexpr MetricRow<Count> kObjects[] = {
    {Gauge, "wallgl_node_objects", "Objects in the node's driver by kind.", [](const Count& n) { return n; }},
};

/// A tile and what is known of it.
struct TileRef {
    TileShown shown;
    std::uint32_t lag;
    double age;  ///< seconds
};
constexpr MetricRow<TileRef> kTiles[] = {
    {Counter, "wallgl_tile_frames_total",
     "Times that the tile was told to show a frame of a window, since walld started.",
     [](const TileRef& t) { return t.shown.frames; }},
    {Gauge, "wallgl_tile_lag_frames", "Frames that the wall shows and this tile does not yet; the most of its windows.",
     [](const TileRef& t) { return t.lag; }},
};
constexpr MetricRow<TileRef> kShownTiles[] = {
    {Gauge, "wallgl_tile_frame_age_seconds",
     "Time since the tile was told to show a frame. It also grows while its windows stand still: see "
     "wallgl_tile_lag_frames.",
     [](const TileRef& t) { return t.age; }},
};

void add_objects(Families& out, const std::vector<Labelled<NodeRef>>& up) {
    std::vector<Labelled<Count>> counts;
    for (const auto& [labels, node] : up) {
        const auto& o = node->stats.objects();
        const std::pair<const char*, Count> kinds[] = {
            {"texture", o.textures()},           {"buffer", o.buffers()}, {"list", o.lists()},
            {"program", o.programs()},           {"shader", o.shaders()}, {"framebuffer", o.framebuffers()},
            {"renderbuffer", o.renderbuffers()}, {"query", o.queries()}};
        for (const auto& [kind, count] : kinds) counts.push_back({{labels.front(), {"kind", kind}}, count});
    }
    add_table(out, kObjects, counts);
}

void add_tiles(Families& out, const Observed& observed) {
    std::vector<Labelled<TileRef>> tiles, shown;
    const auto& nodes = observed.wall.nodes();
    for (const NodeIndex i : nodes.ids()) {
        for (const auto& tile : nodes[i].config->tiles) {
            if (tile.arriving) continue;
            const auto last = nodes[i].shown_in(tile.slot);
            const double age = last.last ? std::chrono::duration<double>(observed.now - *last.last).count() : 0;
            const Labels labels{{"node", nodes[i].config->name}, {"tile", tile.name}};
            tiles.push_back({labels, {last, observed.wall.tile_lag(i, tile), age}});
            if (last.last) shown.push_back(tiles.back());
        }
    }
    add_table(out, kTiles, tiles);
    add_table(out, kShownTiles, shown);
}

}  // namespace

void add_node_metrics(Families& out, const Observed& observed) {
    std::vector<Labelled<NodeRef>> all, up, info;
    for (const auto& node : observed.wall.nodes()) {
        const Labels labels{{"node", node.config->name}};
        all.push_back({labels, &node});
        if (!node.up) continue;
        up.push_back({labels, &node});
        info.push_back({{labels.front(),
                         {"backend", label_text(node.hello.backend())},
                         {"renderer", label_text(node.hello.caps().renderer())},
                         {"version", label_text(node.hello.caps().version())}},
                        &node});
    }
    add_table(out, kAlways, all);
    add_table(out, kNodeInfo, info);
    add_table(out, kWhileUp, up);
    add_objects(out, up);
    add_tiles(out, observed);
}

}  // namespace wall::walld
