// SPDX-License-Identifier: MIT
// The data connection to one node. The application's threads queue whole batches and wait for answers; one transport
// thread per process (transport.h) moves the bytes, so that sending overlaps with packing (W4.1).
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/base/unique_fd.h"
#include "common/wire/frame.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

class NodeStream {
public:
    /// Connects and says hello; at most `timeout_ms` in all. `hello` is an encoded DataHello.
    static Result<std::shared_ptr<NodeStream>> open(const std::string& address, const std::string& hello,
                                                    int timeout_ms);

    static constexpr int kNoLimit = -1;  ///< as timeout_ms

    /// Queues a batch of at most wire::kMaxBatchPayload. Blocks while more than kMaxQueuedBytes wait (the node is
    /// slower than the program), but never longer than `kStallLimitMs` without a byte that goes out: then the stream
    /// counts as failed. Application threads.
    void send(ContextId context, wire::PackBuffer batch);

    /// No stall fails the stream: the node may hold it for others' sake. Before the first send().
    void never_stalls() { stalls_ = false; }

    /// The answer to `request`; nothing if the stream fails or the time is over. Application threads.
    std::optional<std::vector<std::byte>> wait_reply(RequestId request, int timeout_ms);
    /// The same without taking the answer: whether it is there, or none will come. `timeout`: 0 only looks.
    bool wait_until_answered(RequestId request, std::chrono::nanoseconds timeout);
    /// When the answer came; nothing: it has not, or none will. Application threads.
    std::optional<std::chrono::steady_clock::time_point> answered_at(RequestId request) const;
    /// Nobody wants the answer any more, whether it is there or not. Application threads.
    void forget_request(RequestId request);
    /// Waits until the node has drawn `frame` of `surface`; false if it did not in time. Application threads.
    bool wait_swap(SurfaceId surface, std::uint32_t frame, int timeout_ms);

    /// What waits to be written.
    std::size_t queued_bytes() const;

    bool failed() const { return failed_.load(std::memory_order_acquire); }
    std::string failure() const;
    /// The node has said why it ends the stream: opened again, it would come to the same.
    bool ended_by_node() const { return ended_by_node_.load(std::memory_order_acquire); }
    std::uint64_t bytes_sent() const { return bytes_sent_.load(std::memory_order_relaxed); }

    // ---- transport thread ----
    int fd() const { return fd_.get(); }
    bool wants_write();
    void on_writable();
    void on_readable();
    void give_up(const std::string& why);

private:
    explicit NodeStream(UniqueFd fd) : fd_(std::move(fd)) {}
    /// A batch on its way, in as many frames as it takes.
    struct Outgoing {
        std::array<std::byte, 16> lead;  ///< batch header, padding in front of the opcodes
        std::size_t lead_bytes = 0;
        wire::PackBuffer body;
        std::array<std::byte, wire::kFrameHeaderBytes> frame;  ///< of the part that is being sent
        std::size_t part_start = 0, part_bytes = 0;            ///< of the payload
        std::size_t sent = 0;                                  ///< of the part, its frame header included
        std::size_t payload_bytes() const { return lead_bytes + body.bytes(); }
        void begin_part(std::size_t start);
    };
    void handle_frame(wire::FrameKind kind, std::vector<std::byte> payload);
    bool write_some(Outgoing& out);

    template <class Done>
    void wait(std::unique_lock<std::mutex>& lock, int timeout_ms, Done&& done);

    UniqueFd fd_;
    bool stalls_ = true;
    std::atomic<bool> failed_{false}, ended_by_node_{false};
    std::atomic<std::uint64_t> bytes_sent_{0};

    mutable std::mutex mutex_;  // guards what follows
    std::condition_variable changed_;
    std::deque<Outgoing> queue_;
    std::size_t queued_bytes_ = 0;
    struct Reply {
        std::vector<std::byte> bytes;
        std::chrono::steady_clock::time_point at;  ///< when it came
    };
    std::unordered_map<RequestId, Reply> replies_;
    std::unordered_set<RequestId> unwanted_;              ///< requests whose answers nobody waits for any more
    std::unordered_map<SurfaceId, std::uint32_t> swaps_;  // surface -> last frame drawn
    std::string failure_;

    std::vector<std::byte> inbox_;  // transport thread only
    std::size_t inbox_used_ = 0;
};

/// Opens a stream socket to `unix:PATH` or `HOST:PORT`, non-blocking; at most `timeout_ms`.
Result<UniqueFd> connect_to(const std::string& address, int timeout_ms);

}  // namespace wall::client
