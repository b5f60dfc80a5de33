// SPDX-License-Identifier: MIT
// Metrics of live pictures: what viewers watch, what it costs the nodes to encode, what was dropped.
#include <spdlog/fmt/fmt.h>

#include "walld/metrics/metrics.h"

namespace wall::walld {
namespace {

using enum prometheus::MetricType;
using HubRef = const Observed*;

/// A stream as walld and as its node see it.
struct StreamRef {
    const StreamView* view;
    const proto::StreamStats* node;  ///< not told yet: an empty one
};

constexpr MetricRow<HubRef> kHub[] = {
    {Gauge, "wallgl_viewers", "Who watches live pictures.", [](const HubRef& o) { return o->viewers; }},
    {Counter, "wallgl_hub_frames_total", "Frames of live pictures that nodes have sent since walld started.",
     [](const HubRef& o) { return o->hub.frames; }},
    {Counter, "wallgl_hub_bytes_total", "Bytes of live pictures that nodes have sent since walld started.",
     [](const HubRef& o) { return o->hub.bytes; }},
    {Counter, "wallgl_hub_dropped_frames_total",
     "Frames that gave way to a newer one before a viewer took them, since walld started.",
     [](const HubRef& o) { return o->hub.dropped; }},
};
constexpr MetricRow<StreamRef> kStreams[] = {
    {Gauge, "wallgl_stream_viewers", "Who watches the stream.", [](const StreamRef& s) { return s.view->viewers; }},
    {Counter, "wallgl_stream_frames_total", "Frames of the stream that have come from its node.",
     [](const StreamRef& s) { return s.view->frames; }},
    {Counter, "wallgl_stream_dropped_frames_total",
     "Frames of the stream that gave way to a newer one before a viewer took them.",
     [](const StreamRef& s) { return s.view->dropped; }},
    {Counter, "wallgl_stream_encoded_frames_total", "Pictures that the node has encoded for the stream.",
     [](const StreamRef& s) { return s.node->frames(); }},
    {Counter, "wallgl_stream_raw_bytes_total", "Bytes of those pictures before encoding.",
     [](const StreamRef& s) { return s.node->raw_bytes(); }},
    {Counter, "wallgl_stream_packet_bytes_total", "Bytes of those pictures encoded.",
     [](const StreamRef& s) { return s.node->packet_bytes(); }},
    {Counter, "wallgl_stream_encode_seconds_total", "Time that the node has spent in encoding them.",
     [](const StreamRef& s) { return 1e-9 * static_cast<double>(s.node->encode_ns()); }},
};

const proto::StreamStats& told_of(const Node& node, std::uint32_t stream) {
    for (const auto& row : node.stats.streams())
        if (row.stream() == stream) return row;
    return proto::StreamStats::default_instance();
}

}  // namespace

void add_stream_metrics(Families& out, const Observed& observed) {
    add_table(out, kHub, {{{}, &observed}});
    std::vector<Labelled<StreamRef>> streams;
    for (const auto& view : observed.streams) {
        const auto& node = observed.wall.nodes()[view.node];
        const std::string session = !view.session  ? ""
                                    : view.surface ? fmt::format("{}.{}", view.session.value, view.surface.value)
                                                   : std::to_string(view.session.value);
        const std::string region =
            view.crop.empty() ? ""
                              : fmt::format("{},{},{},{}", view.crop.x, view.crop.y, view.crop.width, view.crop.height);
        streams.push_back({{{"node", node.config->name},
                            {"tile", view.tile},
                            {"codec", view.codec},
                            {"size", fmt::format("{}x{}", view.width, view.height)},
                            {"fps", std::to_string(view.fps)},
                            {"session", session},
                            {"region", region},
                            {"output", view.output ? "1" : ""}},
                           {&view, &told_of(node, view.id.value)}});
    }
    add_table(out, kStreams, streams);
}

}  // namespace wall::walld
