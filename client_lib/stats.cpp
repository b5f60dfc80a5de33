// SPDX-License-Identifier: MIT
#include "client_lib/stats.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <mutex>

#include "client_lib/process.h"

namespace wall::client {

namespace detail {
constinit std::array<std::atomic<std::uint64_t>, kCounters> counters{};
constinit std::array<std::atomic<NodeCounts*>, kMaxCountedNodes> node_counts{};
}  // namespace detail

namespace {

using detail::NodeCounts;

constexpr std::array<const char*, kNodeCounters> kNodeCounterNames{"state_bytes", "object_bytes", "geometry_bytes",
                                                                   "blocks", "batches"};
constexpr std::array<const char*, kCounters> kCounterNames{"frames",      "blocks",    "vertices",
                                                           "round_trips", "gl_errors", "node_losses"};

/// Lives for ever: the library has no static destructors.
struct Registry {
    std::mutex mutex;
    std::map<std::string, std::uint64_t> unsupported, events;
    std::string path;
    std::string written;  // what the file holds
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

Registry& registry() {
    static Registry& the = *new Registry;
    return the;
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        char escaped[8];
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
            out += escaped;
        } else {
            out += c;
        }
    }
    return out + '"';
}

template <class Names, class Value>
std::string object(const Names& names, Value&& value) {
    std::string out = "{";
    for (std::size_t i = 0; i < names.size(); ++i)
        out += (i ? ", " : "") + quoted(names[i]) + ": " + std::to_string(value(i));
    return out + "}";
}

std::string object(const std::map<std::string, std::uint64_t>& values) {
    std::string out = "{";
    for (const auto& [name, value] : values)
        out += (out.size() > 1 ? ", " : "") + quoted(name) + ": " + std::to_string(value);
    return out + "}";
}

std::string node_json(std::size_t index, const NodeCounts& node) {
    const auto total = [&](std::size_t i) { return node.total[i].load(std::memory_order_relaxed); };
    std::string out = "{\"node\": " + std::to_string(index) + ", \"frames\": " + std::to_string(node.frames);
    out += ", \"total\": " + object(kNodeCounterNames, total);
    out += ", \"first_frame\": " + object(kNodeCounterNames, [&](std::size_t i) { return node.first[i]; });
    out += ", \"last_frame\": " + object(kNodeCounterNames, [&](std::size_t i) { return node.last[i]; });
    out += ", \"largest_frame\": " + object(kNodeCounterNames, [&](std::size_t i) { return node.most[i]; });
    return out + "}";
}

void end_frame_of(NodeCounts& node) {
    for (std::size_t i = 0; i < kNodeCounters; ++i) {
        const auto now = node.total[i].load(std::memory_order_relaxed);
        node.last[i] = now - node.at_frame_start[i];
        if (node.frames == 0) node.first[i] = node.last[i];
        node.most[i] = std::max(node.most[i], node.last[i]);
        node.at_frame_start[i] = now;
    }
    ++node.frames;
}

std::string json_without_time(Registry& r) {
    std::string out = "\"program\": " + quoted(program_name()) + ",\n \"pid\": " + std::to_string(getpid());
    out += ",\n \"counters\": " +
           object(kCounterNames, [](std::size_t i) { return counted(static_cast<Counter>(i)); });
    std::array<std::uint64_t, kNodeCounters> sums{};
    std::string nodes;
    for (std::size_t n = 0; n < kMaxCountedNodes; ++n) {
        const auto* node = detail::node_counts[n].load(std::memory_order_acquire);
        if (!node) continue;
        nodes += (nodes.empty() ? "\n  " : ",\n  ") + node_json(n, *node);
        for (std::size_t i = 0; i < kNodeCounters; ++i) sums[i] += node->total[i].load(std::memory_order_relaxed);
    }
    out += ",\n \"total\": " + object(kNodeCounterNames, [&](std::size_t i) { return sums[i]; });
    out += ",\n \"nodes\": [" + nodes + "]";
    out += ",\n \"unsupported\": " + object(r.unsupported) + ",\n \"events\": " + object(r.events);
    return out;
}

std::string with_time(const Registry& r, const std::string& body) {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - r.start;
    char text[64];
    snprintf(text, sizeof text, "{\"seconds\": %.3f,\n ", seconds.count());
    return text + body + "}\n";
}

bool write_file(const std::string& path, const std::string& text) {
    const auto temporary = path + ".new";
    FILE* file = fopen(temporary.c_str(), "we");
    if (!file) return false;
    const bool whole = fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool closed = fclose(file) == 0;
    return whole && closed && rename(temporary.c_str(), path.c_str()) == 0;
}

}  // namespace

detail::NodeCounts& detail::make_node_counts(std::size_t node) {
    auto* fresh = new NodeCounts;
    NodeCounts* expected = nullptr;
    if (node_counts[node].compare_exchange_strong(expected, fresh)) return *fresh;
    delete fresh;
    return *expected;
}

std::uint64_t counted(NodeCounter counter, std::uint32_t node) {
    const auto* counts = node < kMaxCountedNodes ? detail::node_counts[node].load(std::memory_order_acquire) : nullptr;
    return counts ? counts->total[static_cast<std::size_t>(counter)].load(std::memory_order_relaxed) : 0;
}

void count_frame() {
    count(Counter::frames);
    std::lock_guard lock(registry().mutex);
    for (auto& node : detail::node_counts)
        if (auto* counts = node.load(std::memory_order_acquire)) end_frame_of(*counts);
}

bool count_unsupported(const char* function) {
    std::lock_guard lock(registry().mutex);
    return registry().unsupported[function]++ == 0;
}

void count_event(const char* name) {
    std::lock_guard lock(registry().mutex);
    ++registry().events[name];
}

std::string stats_json() {
    auto& r = registry();
    std::lock_guard lock(r.mutex);
    return with_time(r, json_without_time(r));
}

void write_stats() {
    auto& r = registry();
    if (r.path.empty()) return;
    std::lock_guard lock(r.mutex);
    auto body = json_without_time(r);
    if (body == r.written) return;
    if (write_file(r.path, with_time(r, body))) r.written = std::move(body);
}

void start_stats() {
    const char* path = getenv("WALLGL_STATS");
    if (!path || !*path) return;
    auto& r = registry();
    {
        std::lock_guard lock(r.mutex);
        if (!r.path.empty()) return;
        r.path = path;
    }
    at_process_end([] {
        if (counted(Counter::frames) > 0 || !registry().unsupported.empty()) write_stats();
    });
}

}  // namespace wall::client
