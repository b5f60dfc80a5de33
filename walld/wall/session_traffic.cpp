// SPDX-License-Identifier: MIT
#include "walld/wall/session_traffic.h"

#include <algorithm>
#include <utility>

namespace wall::walld {
namespace {

/// Of a counter; one that went back began anew.
double grown(std::uint64_t from, std::uint64_t to) { return to > from ? static_cast<double>(to - from) : 0; }

}  // namespace

SentBytes& SentBytes::operator+=(const SentBytes& other) {
    state += other.state;
    object += other.object;
    geometry += other.geometry;
    link += other.link;
    return *this;
}

void SessionTraffic::note(std::uint32_t rank, const proto::ClientStats& report, std::size_t nodes,
                          Clock::time_point now) {
    Process& process = processes_[rank];
    SentBytes sent;
    process.by_node.clear();
    for (const auto& row : report.nodes()) {
        if (row.node() >= nodes) continue;
        const SentBytes bytes{row.state_bytes(), row.object_bytes(), row.geometry_bytes(), row.link_bytes()};
        process.by_node[NodeIndex(row.node())] = bytes;
        sent += bytes;
    }
    const SentBytes before = std::exchange(process.sent, sent);
    if (const double seconds = process.noted ? std::chrono::duration<double>(now - *process.noted).count() : 0;
        seconds > 0) {
        process.rates = {grown(before.state, sent.state) / seconds, grown(before.object, sent.object) / seconds,
                         grown(before.geometry, sent.geometry) / seconds, grown(before.link, sent.link) / seconds, 0};
        const double frames = grown(process.frames, report.frames());
        if (frames > 0) process.rates.frame_bytes = grown(before.all(), sent.all()) / frames;
    }
    process.noted = now;
    process.frames = report.frames();
    process.round_trips = report.round_trips();
    process.lossy_vertices = report.lossy_vertices();
    process.diff_seconds = 1e-9 * static_cast<double>(report.diff_ns());
}

std::map<NodeIndex, SentBytes> SessionTraffic::by_node() const {
    std::map<NodeIndex, SentBytes> out;
    for (const auto& [rank, process] : processes_)
        for (const auto& [node, bytes] : process.by_node) out[node] += bytes;
    return out;
}

SentBytes SessionTraffic::sent() const {
    SentBytes out;
    for (const auto& [rank, process] : processes_) out += process.sent;
    return out;
}

std::uint64_t SessionTraffic::frames() const {
    std::uint64_t most = 0;
    for (const auto& [rank, process] : processes_) most = std::max(most, process.frames);
    return most;
}

std::uint64_t SessionTraffic::round_trips() const {
    std::uint64_t sum = 0;
    for (const auto& [rank, process] : processes_) sum += process.round_trips;
    return sum;
}

std::uint64_t SessionTraffic::lossy_vertices() const {
    std::uint64_t sum = 0;
    for (const auto& [rank, process] : processes_) sum += process.lossy_vertices;
    return sum;
}

double SessionTraffic::diff_seconds() const {
    double sum = 0;
    for (const auto& [rank, process] : processes_) sum += process.diff_seconds;
    return sum;
}

SessionTraffic::Rates SessionTraffic::rates() const {
    Rates sum;
    for (const auto& [rank, process] : processes_) {
        sum.state += process.rates.state;
        sum.object += process.rates.object;
        sum.geometry += process.rates.geometry;
        sum.link += process.rates.link;
        sum.frame_bytes += process.rates.frame_bytes;
    }
    return sum;
}

}  // namespace wall::walld
