// SPDX-License-Identifier: MIT
#include "client_lib/process/stats.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>

#include "client_lib/process/process.h"

namespace wall::client {
namespace {

constexpr std::array<const char*, static_cast<std::size_t>(NodeCounter::kCount)> kCounterNames{
    "state_bytes", "object_bytes", "geometry_bytes", "blocks", "batches", "link_bytes", "handed_bytes"};

constexpr int kWriteLimitMs = 500;  // at the end of the process

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
    return out + '"';
}

template <class Value>
std::string figures_json(Value&& value) {
    std::string out = "{";
    for (std::size_t i = 0; i < kCounterNames.size(); ++i)
        out += (i ? ", " : "") + quoted(kCounterNames[i]) + ": " + std::to_string(value(i));
    return out + "}";
}

template <class Map>
std::string map_json(const Map& values) {
    std::string out = "{";
    for (const auto& [name, value] : values)
        out += (out.size() > 1 ? ", " : "") + quoted(name) + ": " + std::to_string(value);
    return out + "}";
}

template <class Map>
std::uint64_t& entry(Map& map, std::string_view name) {
    const auto found = map.find(name);
    return found != map.end() ? found->second : map.emplace(name, 0).first->second;
}

bool write_file(const std::string& path, const std::string& text) {
    const auto temporary = path + ".new." + std::to_string(getpid());
    FILE* file = fopen(temporary.c_str(), "we");
    if (!file) return false;
    const bool whole = fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool closed = fclose(file) == 0;
    return whole && closed && rename(temporary.c_str(), path.c_str()) == 0;
}

std::string environment_path() {
    const char* path = secure_getenv("WALLGL_STATS");
    return path ? path : "";
}

}  // namespace

Stats::Stats() : path_(environment_path()), start_(std::chrono::steady_clock::now()) {}

Stats::~Stats() {
    for (auto& slot : nodes_) delete slot.load(std::memory_order_relaxed);
}

Stats::NodeCounts& Stats::make_node(std::atomic<NodeCounts*>& slot) {
    auto* fresh = new NodeCounts;
    NodeCounts* expected = nullptr;
    if (slot.compare_exchange_strong(expected, fresh)) return *fresh;
    delete fresh;
    return *expected;
}

std::uint64_t Stats::of_node(NodeIndex node, NodeCounter counter) const {
    const auto* counts = node.value < kMaxNodes ? nodes_[node.value].load(std::memory_order_acquire) : nullptr;
    return counts ? counts->total[static_cast<std::size_t>(counter)].load(std::memory_order_relaxed) : 0;
}

void Stats::add(std::string_view name, std::uint64_t n) {
    std::lock_guard lock(mutex_);
    entry(counters_, name) += n;
}

void Stats::raise(std::string_view name, std::uint64_t value) {
    std::lock_guard lock(mutex_);
    auto& most = entry(counters_, name);
    most = std::max(most, value);
}

std::uint64_t Stats::get(std::string_view name) const {
    std::lock_guard lock(mutex_);
    const auto found = counters_.find(name);
    return found != counters_.end() ? found->second : 0;
}

void Stats::count_round_trip(std::string_view function) {
    std::lock_guard lock(mutex_);
    ++entry(round_trips_, function);
}

bool Stats::count_unsupported(std::string_view function) {
    std::lock_guard lock(mutex_);
    return entry(unsupported_, function)++ == 0;
}

void Stats::end_frame() {
    std::lock_guard lock(mutex_);
    ++frames_;
    for (auto& slot : nodes_) {
        auto* node = slot.load(std::memory_order_acquire);
        if (!node) continue;
        for (std::size_t i = 0; i < kNodeCounters; ++i) {
            const auto now = node->total[i].load(std::memory_order_relaxed);
            node->last[i] = now - node->at_frame_start[i];
            if (node->frames == 0) node->first[i] = node->last[i];
            node->largest[i] = std::max(node->largest[i], node->last[i]);
            node->at_frame_start[i] = now;
        }
        ++node->frames;
    }
}

std::string Stats::node_json(std::size_t index, const NodeCounts& node) {
    const auto total = [&](std::size_t i) { return node.total[i].load(std::memory_order_relaxed); };
    std::string out = "{\"node\": " + std::to_string(index) + ", \"frames\": " + std::to_string(node.frames);
    out += ",\n   \"total\": " + figures_json(total);
    out += ",\n   \"first_frame\": " + figures_json([&](std::size_t i) { return node.first[i]; });
    out += ",\n   \"last_frame\": " + figures_json([&](std::size_t i) { return node.last[i]; });
    out += ",\n   \"largest_frame\": " + figures_json([&](std::size_t i) { return node.largest[i]; });
    return out + "}";
}

// With the mutex held.
std::uint64_t Stats::round_trips() const {
    std::uint64_t sum = 0;
    for (const auto& [name, n] : round_trips_) sum += n;
    return sum;
}

Traffic Stats::traffic() const {
    Traffic out{.diff_time = std::chrono::nanoseconds(diff_ns_.load(std::memory_order_relaxed))};
    for (std::uint32_t n = 0; n < kMaxNodes; ++n) {
        if (!nodes_[n].load(std::memory_order_acquire)) continue;
        const NodeIndex node(n);
        out.nodes.push_back({node, of_node(node, NodeCounter::state_bytes), of_node(node, NodeCounter::object_bytes),
                             of_node(node, NodeCounter::geometry_bytes), of_node(node, NodeCounter::link_bytes)});
    }
    std::lock_guard lock(mutex_);
    out.frames = frames_;
    out.round_trips = round_trips();
    if (const auto lossy = counters_.find(kLossyVertices); lossy != counters_.end()) out.lossy_vertices = lossy->second;
    return out;
}

// With the mutex held; all but the time.
std::string Stats::body() const {
    Figures sums{};
    std::string nodes;
    for (std::size_t n = 0; n < kMaxNodes; ++n) {
        const auto* node = nodes_[n].load(std::memory_order_acquire);
        if (!node) continue;
        nodes += (nodes.empty() ? "\n  " : ",\n  ") + node_json(n, *node);
        for (std::size_t i = 0; i < kNodeCounters; ++i) sums[i] += node->total[i].load(std::memory_order_relaxed);
    }
    std::string out = "\"program\": " + quoted(program_name()) + ",\n \"pid\": " + std::to_string(getpid());
    out += ",\n \"frames\": " + std::to_string(frames_);
    out += ",\n \"total\": " + figures_json([&](std::size_t i) { return sums[i]; });
    out += ",\n \"nodes\": [" + nodes + "]";
    out +=
        ",\n \"diff_seconds\": " + std::to_string(1e-9 * static_cast<double>(diff_ns_.load(std::memory_order_relaxed)));
    out += ",\n \"round_trips\": " + std::to_string(round_trips());
    out += ",\n \"round_trips_by_function\": " + map_json(round_trips_);
    out += ",\n \"unsupported\": " + map_json(unsupported_);
    out += ",\n \"counters\": " + map_json(counters_);
    return out;
}

std::string Stats::json() const {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
    char head[64];
    snprintf(head, sizeof head, "{\"seconds\": %.3f,\n ", seconds.count());
    std::lock_guard lock(mutex_);
    return head + body() + "}\n";
}

void Stats::write() {
    if (path_.empty()) return;
    {
        std::lock_guard lock(mutex_);
        auto now = body();
        if (now == written_) return;
        written_ = std::move(now);
    }
    write_file(path_, json());
}

Stats& stats() {
    static Stats& only = []() -> Stats& {
        auto* made = new Stats;
        at_process_end([] { stats().write(); }, kWriteLimitMs);
        return *made;
    }();
    return only;
}

}  // namespace wall::client
