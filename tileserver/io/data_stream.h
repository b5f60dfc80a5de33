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
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/ids.h"
#include "common/net/control_connection.h"
#include "tileserver/io/frame_reader.h"
#include "tileserver/render/batch_queue.h"
#include "tileserver/render/render_thread.h"

namespace wall::tileserver {

namespace asio = boost::asio;

/// Where it was, for the log, of what is refused here.
inline constexpr const char* kDataPort = "data";

/// What walld has said of a session that may come.
struct Admission {
    std::string ticket;
    Membership membership;
    std::string key{};  ///< fingerprint of the machine that it runs on, which alone may come; empty: any
    SessionQuota quota{};
};

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
};

class DataStream : public std::enable_shared_from_this<DataStream> {
public:
    DataStream(StreamHost& host, StreamId id, net::Stream connection);

    /// Runs until the connection ends.
    asio::awaitable<void> run();
    void send(wire::FrameKind kind, std::span<const std::byte> payload);
    /// Tells the client why and closes.
    void fail(const std::string& reason);
    void close();

    SessionId session() const { return session_; }
    /// The address of the other end, without its port.
    const std::string& from() const { return from_; }

private:
    static constexpr std::size_t kMaxQueued = std::size_t{512} << 20;  // bytes that a client has not read

    asio::awaitable<Result<void>> greet();
    asio::awaitable<Result<void>> take_batches();
    asio::awaitable<void> hold_to_bandwidth(std::size_t bytes);
    asio::awaitable<Result<Frame>> next_frame();
    /// Nothing if there is none for that ticket.
    asio::awaitable<std::optional<Admission>> find_admission(SessionId session, const std::string& ticket);
    asio::awaitable<void> write_queue();
    bool comes_from(const std::string& machine) const;

    StreamHost& host_;
    StreamId id_;
    net::Stream connection_;
    std::string from_;
    asio::steady_timer timer_;  // of whatever run() waits for besides the socket
    FrameReader reader_;
    SessionId session_;
    std::shared_ptr<BatchQueue> batches_;
    std::deque<std::vector<std::byte>> outgoing_;
    std::size_t outgoing_bytes_ = 0;
    std::chrono::steady_clock::time_point read_until_{};  ///< what was read is as much as may come until then
    bool writing_ = false, closing_ = false, room_ = true;
};

}  // namespace wall::tileserver
