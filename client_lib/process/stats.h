// SPDX-License-Identifier: MIT
// Counters of what the library does, written as JSON to the file that WALLGL_STATS names: every second and at the end
// of the process. Any thread; add() and add_node() are a relaxed atomic addition.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

#include "client_lib/process/traffic.h"

namespace wall::client {

/// Counted for each node, in all and frame by frame.
enum class NodeCounter : std::uint8_t {
    state_bytes,     ///< context differences
    object_bytes,    ///< textures, lists, ...
    geometry_bytes,  ///< blocks: vertices and other drawing
    blocks,          ///< blocks sent
    batches,         ///< frames of the data stream
    link_bytes,      ///< that went out: all of these and what is around them, coded where the link asks for it
    handed_bytes,    ///< of objects that another node handed on to it: these did not go out
    kCount
};

class Stats {
public:
    static constexpr std::string_view kLossyVertices = "lossy_vertices";  ///< a name for add()
    static constexpr std::size_t kMaxNodes = 512;                         ///< nodes beyond are counted as the last one

    Stats();
    ~Stats();
    Stats(const Stats&) = delete;

    void add_node(NodeIndex node, NodeCounter counter, std::uint64_t n) {
        auto& slot = nodes_[node.value < kMaxNodes ? node.value : kMaxNodes - 1];
        auto* counts = slot.load(std::memory_order_acquire);
        if (!counts) counts = &make_node(slot);
        counts->total[static_cast<std::size_t>(counter)].fetch_add(n, std::memory_order_relaxed);
    }
    std::uint64_t of_node(NodeIndex node, NodeCounter counter) const;

    /// A counter by name, for things that happen at most some thousand times a second; made at its first use.
    void add(std::string_view name, std::uint64_t n = 1);
    std::uint64_t get(std::string_view name) const;
    /// The same of something that only its largest value counts of.
    void raise(std::string_view name, std::uint64_t value);

    /// An answer was waited for, on behalf of this function.
    void count_round_trip(std::string_view function);
    /// A call of a function that is not implemented. True the first time for each name: then log it.
    bool count_unsupported(std::string_view function);

    /// Time spent in comparing contexts with what nodes hold. Any thread.
    void add_diff_time(std::chrono::nanoseconds time) {
        diff_ns_.fetch_add(static_cast<std::uint64_t>(time.count()), std::memory_order_relaxed);
    }

    /// A frame of a surface has ended: closes the per-frame figures.
    void end_frame();

    Traffic traffic() const;
    std::string json() const;
    /// Writes the file, whole or not at all, if WALLGL_STATS is set and a figure has changed.
    void write();

private:
    static constexpr std::size_t kNodeCounters = static_cast<std::size_t>(NodeCounter::kCount);
    using Figures = std::array<std::uint64_t, kNodeCounters>;
    struct NodeCounts {
        std::array<std::atomic<std::uint64_t>, kNodeCounters> total{};
        Figures at_frame_start{}, first{}, last{}, largest{};  // guarded by the mutex
        std::uint64_t frames = 0;
    };
    using Names = std::map<std::string, std::uint64_t, std::less<>>;

    static NodeCounts& make_node(std::atomic<NodeCounts*>& slot);
    static std::string node_json(std::size_t index, const NodeCounts& node);
    std::string body() const;
    std::uint64_t round_trips() const;

    const std::string path_;
    const std::chrono::steady_clock::time_point start_;
    std::array<std::atomic<NodeCounts*>, kMaxNodes> nodes_{};
    std::atomic<std::uint64_t> diff_ns_{0};

    mutable std::mutex mutex_;  // guards what follows
    Names counters_, round_trips_, unsupported_;
    std::uint64_t frames_ = 0;
    std::string written_;  ///< what the file holds
};

/// The process's counters. Lives for ever: the library has no static destructors.
Stats& stats();

}  // namespace wall::client
