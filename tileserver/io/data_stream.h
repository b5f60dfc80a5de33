// SPDX-License-Identifier: MIT
// One client's data connection: hello and ticket, then batches into a bounded queue for the render thread, answers
// back. I/O thread.
//
//     greeting --hello, good ticket--> open --bad frame, bad batch, session ended--> closing (the error goes out) -->
//     closed
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/ids.h"
#include "common/net/control_connection.h"
#include "common/wire/parcel.h"
#include "tileserver/io/awaited_parcels.h"
#include "tileserver/io/frame_source.h"
#include "tileserver/render/batch_queue.h"
#include "tileserver/render/render_thread.h"

namespace wall::proto {
class DataHello;
}

namespace wall::tileserver {

namespace asio = boost::asio;

/// Where it was, for the log, of what is refused here.
inline constexpr const char* kDataPort = "data";

/// What walld has said of a session that may come.
struct Admission {
    std::string ticket;
    Membership membership;
    std::string key{};  ///< fingerprint of the machine that it runs on, which alone may come; empty: any
    std::vector<std::string> peer_keys{};  ///< of machines whose nodes may bring something for it
    SessionQuota quota{};
};

class DataStream;

/// What a stream needs of the node.
class StreamHost {
public:
    virtual ~StreamHost() = default;
    /// Nothing: not known (yet).
    virtual const Admission* admission(SessionId session) const = 0;
    /// For how much longer the session may not come, if it may not.
    virtual std::optional<std::chrono::seconds> shut_out(SessionId session) const = 0;
    virtual RenderThread& render() = 0;
    virtual void stream_bytes(std::size_t bytes) = 0;
    /// It has shown a valid ticket.
    virtual void stream_open(StreamId stream) = 0;
    virtual void stream_closed(StreamId stream) = 0;
    /// Null: there is none (any more).
    virtual DataStream* stream(StreamId id) = 0;
    /// The process has begun a new stream: it goes on with none that it had before. Nor do the others of a parallel
    /// program, which come to a node together.
    virtual void end_earlier(const DataStream& stream) = 0;

    // ---- parcels (common/wire/parcel.h) ----
    /// The stream that brings the session's commands; null: there is none.
    virtual DataStream* program_stream(SessionId session) = 0;
    /// To another node; comes to its end when more may be handed on to that.
    virtual asio::awaitable<void> hand_on(SessionId session, NodeIndex to, std::uint32_t number, RawBytes piece) = 0;
    /// Nothing comes any more from that node over the connection that it had.
    virtual void lose_parcels(SessionId session, NodeIndex from) = 0;
};

class DataStream : public std::enable_shared_from_this<DataStream> {
public:
    DataStream(StreamHost& host, StreamId id, net::Stream connection);

    /// Runs until the stream ends: with its connection if that is a ring, else some time after it was lost and did not
    /// go on over another one.
    asio::awaitable<void> run();
    void send(wire::FrameKind kind, std::span<const std::byte> payload);
    /// It goes on over this connection; so many of its frames have come to the client. False: it cannot.
    bool go_on(net::Stream& connection, std::uint64_t received, std::uint64_t attempt);
    bool is_before(const DataStream& other) const {
        return resumable_ && session_ == other.session_ && id_ < other.id_ &&
               (rank_ == other.rank_ || !connection_.is_open());
    }
    /// Tells the client why and closes.
    void fail(const std::string& reason);
    void close();

    /// Memory that is kept for batches to come.
    void forget_spares() {
        source_.forget_lent();
        if (batches_) batches_->forget_spares();
    }

    SessionId session() const { return session_; }
    /// It brings a session's commands.
    bool has_commands() const { return batches_ != nullptr && !closing_; }

    // ---- parcels that come for it from other nodes ----
    bool has_room_for(std::uint32_t number, NodeIndex from) const {
        return awaited_.has_room(number, from, batches_->bytes(), BatchQueue::kHighWater);
    }
    void take_parcel(std::uint32_t number, RawBytes batch);
    void note_piece() { awaited_.note(AwaitedParcels::Clock::now()); }
    /// Ends it if one is awaited of a node that is gone, or has been for long: the program begins a new one, and sends
    /// what is needed. Nothing: only the latter.
    void miss_parcels(const std::function<bool(NodeIndex)>& gone);

    /// What brings the program's commands: "ring", "unix", "tcp" or "tls".
    const char* transport() const { return transport_; }
    /// The address of the other end, without its port.
    const std::string& from() const { return from_; }

private:
    static constexpr std::size_t kMaxQueued = std::size_t{512} << 20;  // bytes that a client has not read
    static constexpr std::size_t kMostKept = std::size_t{64} << 20;    // bytes of frames that may have to be sent again
    static constexpr std::size_t kReceiptBytes = 1 << 20;              // after so much the client may forget it
    static constexpr std::uint64_t kReceiptFrames = 256;               // or after so many frames

    struct Outgoing {
        std::vector<std::byte> bytes;
        bool counted = false;  ///< it is sent again if the client has not got it
    };
    struct Connection {
        net::Stream stream;
        std::uint64_t received = 0;  ///< frames, by the client
    };

    asio::awaitable<Result<void>> greet();
    /// Ends with the reason.
    asio::awaitable<Result<void>> take_batches();
    asio::awaitable<Result<void>> wait_for_connection();
    bool may_go_on() const { return resumable_ && !closing_ && source_.connection_lost(); }
    Result<bool> hand_over(const proto::DataHello& hello);
    Result<void> take_receipt(std::span<const std::byte> payload);
    void send_receipt(std::size_t bytes);
    void keep(const std::shared_ptr<const Outgoing>& frame);
    void forget_sent(std::uint64_t received);
    asio::awaitable<void> hold_to_bandwidth(std::size_t bytes);
    /// Nothing if there is none for that ticket.
    asio::awaitable<std::optional<Admission>> find_admission(const proto::DataHello& hello);
    /// Of a node that brings partial pictures. Ends with the reason.
    asio::awaitable<Result<void>> take_partials();
    /// Of a node that hands parcels on. Ends with the reason.
    asio::awaitable<Result<void>> take_parcels();
    Result<std::optional<RawBytes>> add_piece(const wire::ParcelPiece& piece);
    /// Hands it on, if somebody follows. The whole parcel with its last piece.
    asio::awaitable<Result<std::optional<RawBytes>>> take_piece(RawBytes payload);
    Result<void> await_parcel(std::span<const std::byte> payload);
    asio::awaitable<void> wait_for_room();
    asio::awaitable<void> write_queue();
    bool comes_from(const std::string& machine) const;
    bool may_come(const Admission& known, const proto::DataHello& hello) const;

    StreamHost& host_;
    StreamId id_;
    net::Stream connection_;
    std::string from_;
    asio::steady_timer timer_;  // of whatever run() waits for besides the socket
    FrameSource source_;
    const char* transport_ = "";  // once it is admitted
    SessionId session_;
    std::uint32_t rank_ = 0;  // of a parallel program's member
    std::shared_ptr<BatchQueue> batches_;
    std::chrono::steady_clock::time_point read_until_{};  // what was read is as much as may come until then
    std::uint64_t receipt_frames_ = 0;                    // that the last receipt was for
    std::size_t receipt_bytes_ = 0;                       // that have come since

    std::deque<std::shared_ptr<const Outgoing>> outgoing_, sent_;  // sent_: counted ones without a receipt
    std::uint64_t forgotten_ = 0;                                  // counted frames before those of sent_
    std::size_t outgoing_bytes_ = 0, sent_bytes_ = 0;

    // That come over it, by number: what a neighbour hands on comes to it from several others, and so piece by piece.
    struct Parcel {
        std::uint32_t bytes = 0;
        wire::ParcelReader reader{};
    };
    std::map<std::uint32_t, Parcel> unfinished_;
    std::size_t unfinished_bytes_ = 0;
    AwaitedParcels awaited_;  // of its commands

    bool partials_ = false;           // it brings partial pictures, and no commands
    bool parcels_ = false;            // it brings parcels, and no commands
    std::optional<NodeIndex> peer_;   // that brings them
    bool resumable_ = false;          // it may go on over another connection
    bool handed_over_ = false;        // its connection is an earlier stream's now
    std::optional<Connection> next_;  // on which it goes on
    std::uint64_t last_attempt_ = 0;
    bool writing_ = false, closing_ = false, room_ = true;
};

}  // namespace wall::tileserver
