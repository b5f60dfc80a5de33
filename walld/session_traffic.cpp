// SPDX-License-Identifier: MIT
#include "walld/session_traffic.h"

namespace wall::walld {
namespace {

/// Of a counter; one that went back began anew.
double grown(std::uint64_t from, std::uint64_t to) { return to > from ? static_cast<double>(to - from) : 0; }

}  // namespace

SentBytes& SentBytes::operator+=(const SentBytes& other) {
    state += other.state;
    object += other.object;
    geometry += other.geometry;
    return *this;
}

void SessionTraffic::note(const proto::ClientStats& report, std::size_t nodes, Clock::time_point now) {
    SentBytes sent;
    by_node_.clear();
    for (const auto& row : report.nodes()) {
        if (row.node() >= nodes) continue;
        const SentBytes bytes{row.state_bytes(), row.object_bytes(), row.geometry_bytes()};
        by_node_[row.node()] = bytes;
        sent += bytes;
    }
    if (const double seconds = noted_ ? std::chrono::duration<double>(now - *noted_).count() : 0; seconds > 0) {
        rates_ = {grown(sent_.state, sent.state) / seconds, grown(sent_.object, sent.object) / seconds, grown(sent_.geometry, sent.geometry) / seconds, 0};
        const double frames = grown(frames_, report.frames());
        if (frames > 0) rates_.frame_bytes = grown(sent_.all(), sent.all()) / frames;
    }
    noted_ = now;
    sent_ = sent;
    frames_ = report.frames();
    round_trips_ = report.round_trips();
    diff_seconds_ = 1e-9 * static_cast<double>(report.diff_ns());
}

}  // namespace wall::walld
