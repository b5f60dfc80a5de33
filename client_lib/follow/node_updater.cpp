// SPDX-License-Identifier: MIT
#include "client_lib/follow/node_updater.h"

#include <chrono>

#include "client_lib/follow/object_sender.h"
#include "common/glstate/pack_sink.h"

namespace wall::client {
namespace {

constexpr std::uint32_t kDiffSample =
    61;  // one difference in so many is timed: two looks at the clock cost more than comparing equal contexts

}  // namespace

wire::PackBuffer& NodeUpdater::prepare(Node& node, const DrawSource& source, const Needs& needs) {
    wire::PackBuffer& buffer = nodes_.batch(node, source.id);
    Mirror& mirror = node.mirrors[source.id];
    const std::size_t start = buffer.bytes();
    source.draw.note_drawn();
    bind_targets(node, mirror, source.draw, source.read);
    const std::size_t surface_bytes = buffer.bytes() - start;
    const std::size_t object_bytes = bring_up_to_date(nodes_, node, mirror, source, buffer);
    const std::size_t state_start = buffer.bytes();
    const bool sampled = ++prepared_ % kDiffSample == 0;
    const auto diff_start = sampled ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
    glstate::PackSink sink{buffer, mirror.history};
    constexpr auto kCurrent = glstate::mask_of(glstate::Category::current);
    const auto categories = categories_to_send(needs, mirror.state, source.state);
    if (categories & kCurrent) diff_current(mirror.state, source.state, needs, sink);
    glstate::diff_lazily(categories & ~kCurrent, mirror.state, source.state, sink);
    if (sampled) stats().add_diff_time(kDiffSample * (std::chrono::steady_clock::now() - diff_start));
    count(node, NodeCounter::object_bytes, object_bytes);
    count(node, NodeCounter::state_bytes, buffer.bytes() - state_start + surface_bytes);
    return buffer;
}

}  // namespace wall::client
