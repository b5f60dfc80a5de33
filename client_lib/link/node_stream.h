// SPDX-License-Identifier: MIT
// The stream to one node. The application's threads queue whole batches and wait for answers; one transport thread per
// process (transport.h) moves the bytes, so that sending overlaps with packing (W4.1). A stream outlives the connection
// that brings its bytes, unless that is a ring: what the node has not got is sent again over another one (frame.h).
#pragma once

#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "client_lib/link/coding_choice.h"
#include "client_lib/process/options.h"
#include "common/base/ids.h"
#include "common/base/raw_bytes.h"
#include "common/base/result.h"
#include "common/base/unique_fd.h"
#include "common/wire/frame.h"
#include "common/wire/history_coder.h"
#include "common/wire/pack_buffer.h"
#include "common/wire/parcel.h"
#include "common/wire/ring.h"

namespace wall::client {

class StreamAttempts;

class NodeStream {
public:
    /// Connects and says hello; at most `timeout_ms` in all. `hello` is an encoded DataHello. `ring`: to a node on this
    /// machine batches go through shared memory, if it and the system let them.
    static Result<std::shared_ptr<NodeStream>> open(const std::string& address, const std::string& hello,
                                                    int timeout_ms, bool ring = options().ring,
                                                    Coding coding = options().coding);
    bool has_ring() const { return ring_.has_value(); }

    ~NodeStream();

    static constexpr int kNoLimit = -1;  ///< as timeout_ms

    /// Queues a batch of at most wire::kMaxBatchPayload. Blocks while more than kMaxQueuedBytes wait (the node is
    /// slower than the program), but never longer than `kStallLimitMs` without a byte that goes out: then the stream
    /// counts as failed. Application threads.
    void send(ContextId context, wire::PackBuffer batch);

    /// The same of a batch that several nodes get alike: this node, the first of `route`, hands it on to the others.
    void send_parcel(std::uint32_t number, std::vector<NodeIndex> route, ContextId context, wire::PackBuffer batch);
    /// In such a stream of one of the others: here comes what `from` hands on.
    void await_parcel(std::uint32_t number, NodeIndex from);
    /// Whether it goes over a link, which it outlives, and not within this machine.
    bool over_link() const { return number_ != 0; }
    /// What the node says of parcels: one of them has come to all, or a neighbour may not have got what was for it.
    struct ParcelNews {
        std::optional<std::uint32_t> handed_on;
        std::optional<NodeIndex> missed;
    };
    using OnParcel = std::function<void(const ParcelNews& news)>;  ///< transport thread
    /// Before it is given to the transport.
    void on_parcel(OnParcel call) { on_parcel_ = std::move(call); }

    /// An empty buffer for a batch, with memory that a sent one has left: memory that is new costs the system more than
    /// the bytes that are packed into it. Application threads.
    wire::PackBuffer spare();

    /// No stall fails the stream: the node may hold it for others' sake. Before the first send().
    void never_stalls() { stalls_ = false; }
    /// Whose bytes these are in the statistics. Before it is given to the transport.
    void count_for(NodeIndex node) { counted_for_ = node; }

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
    /// When it said that it has drawn its latest frame of `surface`; nothing: none yet. Application threads.
    std::optional<std::chrono::steady_clock::time_point> last_swap(SurfaceId surface) const;

    /// What is sent just now is coded. Any thread.
    bool codes() const {
        std::lock_guard lock(mutex_);
        return number_ != 0 && choice_.codes();
    }
    /// `frame` of `surface` was sent: the node is waited for until it has drawn it. Application threads.
    void expect_swap(SurfaceId surface, std::uint32_t frame);

    /// What waits to be written.
    std::size_t queued_bytes() const;

    /// The node wants to be told anew all that it has; once for each time that it has said so. Application threads.
    bool take_begin_again() { return begin_again_.exchange(false, std::memory_order_relaxed); }

    bool failed() const { return failed_.load(std::memory_order_acquire); }
    std::string failure() const;
    /// The node has said why it ends the stream: opened again, it would come to the same.
    bool ended_by_node() const { return ended_by_node_.load(std::memory_order_acquire); }
    std::uint64_t bytes_sent() const { return bytes_sent_.load(std::memory_order_relaxed); }

    // ---- transport thread ----
    int fd() const { return fd_.get(); }  ///< -1: the connection is lost
    /// If the connection is lost: whether there is another one by now.
    void go_on();
    bool wants_write();
    /// For poll(): with a ring the node says when there is room.
    bool waits_for_socket() { return !ring_ && wants_write(); }
    void on_writable();
    void on_readable();
    void give_up(const std::string& why);

private:
    NodeStream(UniqueFd fd, std::optional<wire::RingWriter> ring, std::uint32_t number, std::string address,
               std::string hello, Coding coding)
        : fd_(std::move(fd)),
          ring_(std::move(ring)),
          number_(number),
          address_(std::move(address)),
          hello_(std::move(hello)),
          choice_(coding) {}
    /// A batch, or what is not sent as one, on its way, in as many frames as it takes.
    struct Outgoing {
        wire::FrameKind kind = wire::FrameKind::batch;
        wire::ParcelLead parcel;           ///< of such a one
        std::array<std::byte, 16> lead{};  ///< batch header, padding in front of the opcodes
        std::size_t lead_bytes = 0;
        wire::PackBuffer body;
        std::size_t plain_bytes = 0;                 ///< of lead and body
        bool decided = false;                        ///< whether it is coded: it is sent again as it was sent before
        std::vector<std::byte> coded;                ///< once it was, a whole frame's payload instead of them
        std::vector<std::byte> front;                ///< of the part that is being sent: its frame header and more
        std::uint64_t part = 0;                      ///< which one that is
        std::size_t part_start = 0, part_bytes = 0;  ///< of the payload
        std::size_t sent = 0;                        ///< of the part, what is in front included
        std::uint64_t first_frame = 0;               ///< by its number in the stream
        std::uint64_t frames = 1;                    ///< as many, also once it is coded
        bool has_begun() const { return sent != 0 || part != 0; }
        bool is_coded() const { return !coded.empty(); }
        std::size_t payload_bytes() const { return is_coded() ? coded.size() : plain_bytes; }
        /// Bytes of the payload in front of that part.
        std::size_t start_of(std::uint64_t part) const;
        void begin_part(std::uint64_t part);
    };
    /// What is to be sent next of a part, from memory that is not in one piece.
    struct Pieces {
        std::array<iovec, 3> at;
        std::size_t count = 0;
    };
    static Pieces pieces_of(const Outgoing& out);
    static Outgoing outgoing(ContextId context, wire::PackBuffer batch);
    void queue(Outgoing out);
    /// After a change of `owed_` or `blocked_`, with the mutex.
    void note_waiting();
    void set_blocked(bool blocked);
    void handle_frame(wire::FrameKind kind, std::vector<std::byte> payload);
    void hear_of_parcel(wire::FrameKind kind, std::span<const std::byte> payload) const;
    void take_receipt(std::uint64_t frames);
    bool write_receipt();
    bool receipt_is_due() const;
    /// The connection is; the stream goes on over another one if it can.
    void lost(const std::string& why);
    void begin_again(std::uint64_t received);
    bool may_be_coded(const Outgoing& out) const;
    void code(Outgoing& out);
    /// True: all of it is out.
    bool write_some(Outgoing& out);
    /// How many bytes went out; nothing: no room, or the stream has failed.
    std::optional<std::size_t> write_socket(Pieces pieces);
    std::optional<std::size_t> write_ring(const Pieces& pieces);
    void cannot_send();
    void keep(wire::PackBuffer sent);

    template <class Done>
    void wait(std::unique_lock<std::mutex>& lock, int timeout_ms, Done&& done);

    UniqueFd fd_;
    std::optional<wire::RingWriter> ring_;  // transport thread
    const std::uint32_t number_;            // by which the node knows it; 0: it ends with its connection
    const std::string address_, hello_;     // to come to it again
    std::optional<NodeIndex> counted_for_;
    OnParcel on_parcel_;
    std::shared_ptr<StreamAttempts> attempts_;  // to go on; transport thread
    std::atomic<bool> connected_{true};
    bool stalls_ = true;
    std::atomic<bool> failed_{false}, ended_by_node_{false}, begin_again_{false};
    std::atomic<std::uint64_t> bytes_sent_{0};

    mutable std::mutex mutex_;  // guards what follows
    std::condition_variable changed_;
    std::deque<Outgoing> queue_;
    std::deque<Outgoing> sent_;  // all of it, and the node has not said yet that it has got it
    std::size_t queued_bytes_ = 0, sent_bytes_ = 0;
    std::uint64_t next_frame_ = 0;  // its number
    std::vector<wire::PackBuffer> spare_;
    struct Reply {
        std::vector<std::byte> bytes;
        std::chrono::steady_clock::time_point at;  ///< when it came
    };
    std::unordered_map<RequestId, Reply> replies_;
    std::unordered_set<RequestId> unwanted_;  ///< requests whose answers nobody waits for any more
    struct Drawn {
        std::uint32_t frame;
        std::chrono::steady_clock::time_point at;
    };
    std::unordered_map<SurfaceId, Drawn> swaps_;  // the last frame of each surface
    // How long the node was waited for: to draw frames, or to take bytes.
    std::unordered_map<SurfaceId, std::uint32_t> owed_;
    bool blocked_ = false;
    std::optional<std::chrono::steady_clock::time_point> waits_since_;
    std::chrono::steady_clock::duration waited_{};
    std::string failure_;

    // transport thread only
    CodingChoice choice_;
    std::optional<wire::HistoryEncoder> encoder_;
    RawBytes coding_room_;  // for what it makes
    bool cannot_code_ = false;
    std::uint64_t received_ = 0, receipt_for_ = 0;  // counted frames; those that the node knows of
    std::size_t unreceipted_bytes_ = 0;
    std::vector<std::byte> control_;  // a receipt on its way
    std::size_t control_sent_ = 0;
    std::vector<std::byte> inbox_;
    std::size_t inbox_used_ = 0;
};

}  // namespace wall::client
