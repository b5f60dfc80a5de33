// SPDX-License-Identifier: MIT
#include "tileserver/io/data_stream.h"

#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <chrono>

#include "common/log/log.h"
#include "common/log/refusals.h"
#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"
#include "proto/control.pb.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

constexpr auto kWaitable = asio::as_tuple(asio::use_awaitable);
constexpr std::uint32_t kMaxHello = 4 << 10;  // bytes
constexpr auto kGreetingLimit = 5s;           // for the hello to come
constexpr const char *kNoHello = "no hello came", *kClosed = "closed";
constexpr auto kTicketLimit = 3s;  // walld's ticket may come later than the client
constexpr auto kTicketPoll = 10ms;
constexpr auto kAhead = 100ms;  // of the bandwidth that a session may have

/// The other end has closed the socket, and nothing that it sent before is left.
bool is_gone(int socket) {
    char byte;
    const ssize_t peeked = ::recv(socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return peeked == 0 || (peeked < 0 && errno != EAGAIN && errno != EINTR);
}

/// Takes the same time wherever they differ.
bool equal_secret(const std::string& a, const std::string& b) {
    unsigned char difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        difference |= static_cast<unsigned char>(a[i] ^ b[i]);
    return difference == 0;
}

}  // namespace

DataStream::DataStream(StreamHost& host, StreamId id, net::Stream connection)
    : host_(host),
      id_(id),
      connection_(std::move(connection)),
      from_(net::peer_text(connection_.descriptor())),
      timer_(connection_.executor()),
      reader_(kMaxHello) {}

asio::awaitable<void> DataStream::run() {
    const auto self = shared_from_this();
    auto done = co_await greet();
    const bool admitted = done.has_value();
    if (done) done = co_await take_batches();
    if (!done && !closing_) {
        const std::string& why = done.error().message;
        if (admitted || why == kClosed)
            log::info("stream_ended stream={} session={} reason={}", id_.value, session_.value, log::quoted(why));
        else log::refused(kDataPort, from_, why);
        fail(why);
    }
    if (batches_) host_.render().remove_stream(id_);
    host_.stream_closed(id_);
}

asio::awaitable<Result<Frame>> DataStream::next_frame() {
    for (;;) {
        auto frame = reader_.next();
        if (!frame) co_return tl::unexpected(frame.error());
        if (*frame) co_return std::move(**frame);
        const auto room = reader_.prepare();
        const auto [error, bytes] = co_await connection_.read_some(asio::buffer(room.data(), room.size()));
        if (error) co_return wall::fail(error == asio::error::eof ? kClosed : error.message());
        reader_.commit(bytes);
        host_.stream_bytes(bytes);
    }
}

asio::awaitable<Result<void>> DataStream::greet() {
    timer_.expires_after(kGreetingLimit);
    timer_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
        const auto self = weak.lock();
        if (!self || error) return;
        log::refused(kDataPort, self->from_, kNoHello);
        self->fail(kNoHello);
    });
    auto frame = co_await next_frame();
    timer_.cancel();
    if (!frame) co_return tl::unexpected(frame.error());
    proto::DataHello hello;
    if (frame->kind != wire::FrameKind::hello ||
        !hello.ParseFromArray(frame->payload.data(), static_cast<int>(frame->payload.size())))
        co_return wall::fail("the first frame is not a hello");
    if (hello.version() != glapi::kStreamVersion)
        co_return wall::fail("the program's WallGL library is of another version than this node");
    session_ = SessionId(hello.session());
    const auto admission = co_await find_admission(session_, hello.ticket());
    if (!admission) co_return wall::fail("no valid ticket for session " + std::to_string(hello.session()));
    if (const auto wait = host_.shut_out(session_))
        co_return wall::fail("session " + std::to_string(hello.session()) +
                             " kept this node for itself; it is not let in for another " +
                             std::to_string(wait->count()) + " s");
    if (hello.rank() >= std::max(1u, admission->membership.members))
        co_return wall::fail("session " + std::to_string(hello.session()) + " has no rank " +
                             std::to_string(hello.rank()));
    reader_.set_limits(wire::kMaxFramePayload, wire::kMaxBatchPayload);
    const auto on_room = [weak = weak_from_this(), executor = connection_.executor()] {
        asio::post(executor, [weak] {
            if (const auto self = weak.lock()) {
                self->room_ = true;
                self->timer_.cancel();
            }
        });
    };
    batches_ = std::make_shared<BatchQueue>(on_room);
    host_.render().add_stream(id_, session_, batches_, admission->membership, hello.rank());
    host_.stream_open(id_);
    send(wire::FrameKind::welcome, {});
    log::info("stream_open stream={} session={}", id_.value, session_.value);
    co_return Result<void>{};
}

/// A ticket that was taken along to another machine is none.
bool DataStream::comes_from(const std::string& machine) const {
    const auto& key = connection_.peer_key();
    return machine.empty() || (key && key->bytes() == machine);
}

asio::awaitable<std::optional<Admission>> DataStream::find_admission(SessionId session, const std::string& given) {
    const auto until = std::chrono::steady_clock::now() + kTicketLimit;
    for (;;) {
        if (const Admission* known = host_.admission(session))
            co_return session&& equal_secret(known->ticket, given) && comes_from(known->key) ? std::optional(*known)
                                                                                             : std::nullopt;
        if (std::chrono::steady_clock::now() > until || closing_ || is_gone(connection_.descriptor()))
            co_return std::nullopt;
        timer_.expires_after(kTicketPoll);
        co_await timer_.async_wait(kWaitable);
    }
}

asio::awaitable<Result<void>> DataStream::take_batches() {
    while (!closing_) {
        auto frame = co_await next_frame();
        if (!frame) co_return tl::unexpected(frame.error());
        if (frame->kind != wire::FrameKind::batch)
            co_return wall::fail("unexpected frame of kind " + std::to_string(static_cast<int>(frame->kind)));
        const auto bytes = frame->payload.size();
        room_ = batches_->push(std::move(frame->payload));
        host_.render().wake();
        co_await hold_to_bandwidth(bytes);
        while (!room_ && !closing_) {
            timer_.expires_after(1s);
            co_await timer_.async_wait(kWaitable);
        }
    }
    co_return Result<void>{};
}

/// Waits until so much more may have come. A moment's worth may be ahead of that, so that small frames are not late.
asio::awaitable<void> DataStream::hold_to_bandwidth(std::size_t bytes) {
    const Admission* admission = host_.admission(session_);
    const auto most = admission ? admission->quota.bytes_per_second : 0;
    if (most == 0) co_return;
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> takes(static_cast<double>(bytes) / static_cast<double>(most));
    read_until_ = std::max(read_until_, now) + std::chrono::duration_cast<std::chrono::nanoseconds>(takes);
    while (!closing_ && std::chrono::steady_clock::now() < read_until_ - kAhead) {
        timer_.expires_at(read_until_ - kAhead);
        co_await timer_.async_wait(kWaitable);
    }
}

void DataStream::send(wire::FrameKind kind, std::span<const std::byte> payload) {
    if (closing_) return;
    const auto header = wire::encode_frame_header({static_cast<std::uint32_t>(payload.size()), kind});
    std::vector<std::byte> bytes(header.begin(), header.end());
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    outgoing_bytes_ += bytes.size();
    outgoing_.push_back(std::move(bytes));
    if (outgoing_bytes_ > kMaxQueued) return close();
    if (!std::exchange(writing_, true)) asio::co_spawn(connection_.executor(), write_queue(), asio::detached);
}

asio::awaitable<void> DataStream::write_queue() {
    const auto self = shared_from_this();
    while (!outgoing_.empty()) {
        const auto bytes = std::move(outgoing_.front());
        outgoing_.pop_front();
        const auto [error, written] = co_await connection_.write(asio::buffer(bytes.data(), bytes.size()));
        outgoing_bytes_ -= bytes.size();
        if (error) break;
    }
    writing_ = false;
    if (closing_) close();
}

void DataStream::fail(const std::string& reason) {
    send(wire::FrameKind::error, std::as_bytes(std::span(reason)));
    closing_ = true;
    timer_.cancel();
    connection_.shut_reading();
}

void DataStream::close() {
    closing_ = true;
    timer_.cancel();
    connection_.close();
}

}  // namespace wall::tileserver
