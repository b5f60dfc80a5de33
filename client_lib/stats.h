// SPDX-License-Identifier: MIT
// Counters of what the library does, written as JSON to the file that WALLGL_STATS names: every second and at the end
// of the process. Counting is a relaxed atomic addition; any thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace wall::client {

/// Counted for each node, in all and frame by frame.
enum class NodeCounter : std::uint8_t {
    state_bytes,     ///< context differences
    object_bytes,    ///< textures, lists, ...
    geometry_bytes,  ///< blocks: vertices and other drawing
    blocks,          ///< blocks sent
    batches,         ///< frames of the data stream
    kCount
};
inline constexpr std::size_t kNodeCounters = static_cast<std::size_t>(NodeCounter::kCount);
inline constexpr std::size_t kMaxCountedNodes = 512;  ///< nodes beyond are counted as the last one

/// Counted for the process.
enum class Counter : std::uint8_t {
    frames,       ///< ended by count_frame()
    blocks,       ///< before they are sorted to nodes
    vertices,     ///< packed
    round_trips,  ///< answers waited for
    gl_errors,    ///< recorded
    node_losses,  ///< streams that failed
    kCount
};
inline constexpr std::size_t kCounters = static_cast<std::size_t>(Counter::kCount);

namespace detail {
struct NodeCounts {
    std::array<std::atomic<std::uint64_t>, kNodeCounters> total{};
    std::array<std::uint64_t, kNodeCounters> at_frame_start{};  // the rest: guarded by the registry's mutex
    std::array<std::uint64_t, kNodeCounters> first{}, last{}, most{};
    std::uint64_t frames = 0;
};
extern std::array<std::atomic<std::uint64_t>, kCounters> counters;
extern std::array<std::atomic<NodeCounts*>, kMaxCountedNodes> node_counts;
NodeCounts& make_node_counts(std::size_t node);
}  // namespace detail

inline void count(Counter counter, std::uint64_t n = 1) {
    detail::counters[static_cast<std::size_t>(counter)].fetch_add(n, std::memory_order_relaxed);
}
inline std::uint64_t counted(Counter counter) {
    return detail::counters[static_cast<std::size_t>(counter)].load(std::memory_order_relaxed);
}

inline void count(NodeCounter counter, std::uint32_t node, std::uint64_t n) {
    const std::size_t i = node < kMaxCountedNodes ? node : kMaxCountedNodes - 1;
    auto* counts = detail::node_counts[i].load(std::memory_order_acquire);
    if (!counts) counts = &detail::make_node_counts(i);
    counts->total[static_cast<std::size_t>(counter)].fetch_add(n, std::memory_order_relaxed);
}
std::uint64_t counted(NodeCounter counter, std::uint32_t node);

/// A frame of a surface has ended: closes the per-frame figures.
void count_frame();
/// A call of a function that is not implemented yet. Returns true the first time for each name (then log it).
bool count_unsupported(const char* function);
/// Times something was done that has no counter of its own; shown under "events".
void count_event(const char* name);

/// Writes the file if WALLGL_STATS is set and at least one figure changed. Whole or not at all (rename).
void write_stats();
/// The JSON text.
std::string stats_json();
/// Registers write_stats() for the end of the process. Called once, when the library is loaded.
void start_stats();

}  // namespace wall::client
