// SPDX-License-Identifier: MIT
#include "tileserver/io/data_stream.h"

#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>

#include "common/log/log.h"
#include "common/log/refusals.h"
#include "common/net/as_tuple.h"
#include "common/tls/secret.h"
#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"
#include "proto/control.pb.h"
#include "tileserver/partials/partial_format.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kMaxHello = 4 << 10;  // bytes
constexpr auto kGreetingLimit = 5s;           // for the hello to come
constexpr const char* kNoHello = "no hello came";
constexpr auto kTicketLimit = 3s;  // walld's ticket may come later than the client
constexpr auto kTicketPoll = 10ms;
constexpr auto kAhead = 100ms;  // of the bandwidth that a session may have
constexpr auto kRoomPoll = 5ms;
constexpr std::size_t kMostUnfinished = 256;  // parcels of one connection
constexpr auto kAwaited = 15s;                // for a client whose connection was lost; it tries for less

/// The other end has closed the socket, and nothing that it sent before is left.
bool is_gone(int socket) {
    char byte;
    const ssize_t peeked = ::recv(socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return peeked == 0 || (peeked < 0 && errno != EAGAIN && errno != EINTR);
}

bool is_counted(wire::FrameKind kind) { return kind == wire::FrameKind::reply || kind == wire::FrameKind::swap_done; }

}  // namespace

DataStream::DataStream(StreamHost& host, StreamId id, net::Stream connection)
    : host_(host),
      id_(id),
      connection_(std::move(connection)),
      from_(net::peer_text(connection_.descriptor())),
      timer_(connection_.executor()),
      source_(connection_, kMaxHello, [this](std::size_t bytes) { host_.stream_bytes(bytes); }) {}

asio::awaitable<void> DataStream::run() {
    const auto self = shared_from_this();
    auto done = co_await greet();
    const bool admitted = done.has_value();
    while (done && !handed_over_) {
        if (partials_) done = co_await take_partials();
        else if (parcels_) done = co_await take_parcels();
        else done = co_await take_batches();
        if (!may_go_on()) break;
        log::info("stream_lost stream={} session={} reason={}", id_.value, session_.value,
                  log::quoted(done.error().message));
        done = co_await wait_for_connection();
    }
    if (!done && !closing_) {
        const std::string& why = done.error().message;
        if (admitted || why == FrameSource::kClosed)
            log::info("stream_ended stream={} session={} reason={}", id_.value, session_.value, log::quoted(why));
        else log::refused(kDataPort, from_, why);
        fail(why);
    }
    if (batches_) host_.render().remove_stream(id_);
    host_.stream_closed(id_);
}

asio::awaitable<Result<void>> DataStream::greet() {
    timer_.expires_after(kGreetingLimit);
    timer_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
        const auto self = weak.lock();
        if (!self || error) return;
        log::refused(kDataPort, self->from_, kNoHello);
        self->fail(kNoHello);
    });
    auto frame = co_await source_.next();
    timer_.cancel();
    if (!frame) co_return tl::unexpected(frame.error());
    proto::DataHello hello;
    if (frame->kind != wire::FrameKind::hello ||
        !hello.ParseFromArray(frame->payload.data(), static_cast<int>(frame->payload.size())))
        co_return wall::fail("the first frame is not a hello");
    if (hello.version() != glapi::kStreamVersion)
        co_return wall::fail("the program's WallGL library is of another version than this node");
    session_ = SessionId(hello.session());
    const auto admission = co_await find_admission(hello);
    if (!admission) co_return wall::fail("no valid ticket for session " + std::to_string(hello.session()));
    if (const auto wait = host_.shut_out(session_))
        co_return wall::fail("session " + std::to_string(hello.session()) +
                             " kept this node for itself; it is not let in for another " +
                             std::to_string(wait->count()) + " s");
    if (hello.rank() >= std::max(1u, admission->membership.members))
        co_return wall::fail("session " + std::to_string(hello.session()) + " has no rank " +
                             std::to_string(hello.rank()));
    if (hello.partials() || hello.parcels()) {
        partials_ = hello.partials();
        parcels_ = !partials_;
        source_.set_limits(wire::kMaxFramePayload, wire::kMaxFramePayload);
        host_.stream_open(id_);
        log::info("peer_open stream={} session={} transport={} brings={}", id_.value, session_.value,
                  log::quoted(connection_.transport()), log::quoted(partials_ ? "partials" : "parcels"));
        co_return Result<void>{};
    }
    rank_ = hello.rank();
    if (hello.has_resume()) {
        const auto handed = hand_over(hello);
        if (!handed) co_return tl::unexpected(handed.error());
        handed_over_ = true;
        co_return Result<void>{};
    }
    const auto ring = source_.take_ring([this] { send(wire::FrameKind::room, {}); });
    if (!ring) co_return tl::unexpected(ring.error());
    source_.set_limits(wire::kMaxFramePayload, wire::kMaxBatchPayload);
    host_.end_earlier(*this);
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
    transport_ = *ring ? "ring" : connection_.transport();
    resumable_ = !connection_.is_local();
    const std::uint32_t number = resumable_ ? id_.value : 0;
    if (*ring) send(wire::FrameKind::ring, {});
    else send(wire::FrameKind::welcome, std::as_bytes(std::span(&number, 1)));
    log::info("stream_open stream={} session={} transport={}", id_.value, session_.value, log::quoted(transport_));
    co_return Result<void>{};
}

/// A ticket that was taken along to another machine is none.
bool DataStream::comes_from(const std::string& machine) const {
    const auto& key = connection_.peer_key();
    return machine.empty() || (key && key->bytes() == machine);
}

/// A program comes from its machine, what nodes bring from machines of nodes.
bool DataStream::may_come(const Admission& known, const proto::DataHello& hello) const {
    if (!SessionId(hello.session()) || !tls::same_secret(known.ticket, hello.ticket())) return false;
    if (!hello.partials() && !hello.parcels()) return comes_from(known.key);
    const auto& key = connection_.peer_key();
    return !key || std::ranges::count(known.peer_keys, key->bytes()) > 0;
}

asio::awaitable<std::optional<Admission>> DataStream::find_admission(const proto::DataHello& hello) {
    const auto until = std::chrono::steady_clock::now() + kTicketLimit;
    for (;;) {
        const Admission* known = host_.admission(SessionId(hello.session()));
        if (known && may_come(*known, hello)) co_return *known;
        if (known && !hello.partials() && !hello.parcels())
            co_return std::nullopt;  // a new node may come before its key
        if (std::chrono::steady_clock::now() > until || closing_ || is_gone(connection_.descriptor()))
            co_return std::nullopt;
        timer_.expires_after(kTicketPoll);
        co_await timer_.async_wait(net::kTuple);
    }
}

asio::awaitable<Result<void>> DataStream::take_partials() {
    std::optional<NodeIndex> from;
    while (!closing_) {
        auto frame = co_await source_.next();
        if (!frame) {
            if (from) host_.render().lose_partials(session_, *from);
            co_return tl::unexpected(frame.error());
        }
        if (frame->kind != wire::FrameKind::partial)
            co_return wall::fail("unexpected frame of kind " + std::to_string(static_cast<int>(frame->kind)));
        const auto& payload = frame->payload;
        if (const auto key = key_of_partial(payload)) from = key->from;
        auto taken = host_.render().take_partial(session_, {payload.begin(), payload.end()});
        if (!taken) co_return taken;
    }
    co_return Result<void>{};
}

asio::awaitable<Result<void>> DataStream::take_batches() {
    while (!closing_) {
        source_.lend(batches_->take_spare());
        auto frame = co_await source_.next();
        if (!frame) co_return tl::unexpected(frame.error());
        const auto bytes = frame->payload.size();
        switch (frame->kind) {
            case wire::FrameKind::receipt:
                if (auto taken = take_receipt(frame->payload); !taken) co_return taken;
                continue;
            case wire::FrameKind::batch: room_ = batches_->push(std::move(frame->payload)); break;
            case wire::FrameKind::parcel: {
                auto whole = co_await take_piece(std::move(frame->payload));
                if (!whole) co_return tl::unexpected(whole.error());
                if (*whole) room_ = batches_->push(std::move(**whole));
                break;
            }
            case wire::FrameKind::awaited:
                if (auto placed = await_parcel(frame->payload); !placed) co_return placed;
                break;
            default: co_return wall::fail("unexpected frame of kind " + std::to_string(static_cast<int>(frame->kind)));
        }
        host_.render().wake();
        send_receipt(bytes);
        co_await hold_to_bandwidth(bytes);
        co_await wait_for_room();
    }
    co_return Result<void>{};
}

asio::awaitable<void> DataStream::wait_for_room() {
    while (!room_ && !closing_ && !next_) {
        timer_.expires_after(1s);
        co_await timer_.async_wait(net::kTuple);
    }
}

// ---- parcels ----

/// One whose rest does not come, as who handed it on is gone, makes way in the end.
Result<std::optional<RawBytes>> DataStream::add_piece(const wire::ParcelPiece& piece) {
    const auto [place, begun] = unfinished_.try_emplace(piece.lead.number, Parcel{piece.lead.bytes});
    if (begun) unfinished_bytes_ += piece.lead.bytes;
    auto whole = place->second.reader.take(piece);
    const auto forget = [this](auto parcel) {
        unfinished_bytes_ -= parcel->second.bytes;
        unfinished_.erase(parcel);
    };
    if (!whole || *whole) forget(place);
    while (unfinished_.size() > 1 && (unfinished_bytes_ > wire::kMostParcel || unfinished_.size() > kMostUnfinished))
        forget(unfinished_.begin());
    return whole;
}

asio::awaitable<Result<std::optional<RawBytes>>> DataStream::take_piece(RawBytes payload) {
    const auto piece = wire::read_parcel_piece(payload);
    if (!piece) co_return tl::unexpected(piece.error());
    auto whole = add_piece(*piece);
    if (const auto next = piece->lead.next(); whole && next) {
        const std::uint32_t number = piece->lead.number;
        wire::hand_on_piece(payload);
        co_await host_.hand_on(session_, *next, number, std::move(payload));
    }
    co_return whole;
}

/// Where they come too soon, the node that brings them waits.
asio::awaitable<Result<void>> DataStream::take_parcels() {
    Result<void> done;
    while (!closing_ && done) {
        auto frame = co_await source_.next();
        if (!frame) done = tl::unexpected(frame.error());
        else if (frame->kind != wire::FrameKind::parcel) done = wall::fail("unexpected frame of a node that hands on");
        if (!done) break;
        const auto piece = wire::read_parcel_piece(frame->payload);
        if (!piece || piece->lead.position == 0) {
            done = piece ? wall::fail("parcel: of nobody") : tl::unexpected(piece.error());
            break;
        }
        const std::uint32_t number = piece->lead.number;
        const bool is_last = !piece->lead.next();
        peer_ = piece->lead.route[piece->lead.position - 1];
        if (DataStream* to = host_.program_stream(session_)) to->note_piece();
        auto whole = co_await take_piece(std::move(frame->payload));
        if (!whole) done = tl::unexpected(whole.error());
        if (!whole || !*whole) continue;
        const auto has_room = [&] {
            const DataStream* to = host_.program_stream(session_);
            return to == nullptr || to->has_room_for(number, *peer_);
        };
        while (!closing_ && !has_room()) {
            timer_.expires_after(kRoomPoll);
            co_await timer_.async_wait(net::kTuple);
        }
        DataStream* const to = host_.program_stream(session_);
        if (to == nullptr) continue;
        if (is_last) to->send(wire::FrameKind::handed_on, std::as_bytes(std::span(&number, 1)));
        to->take_parcel(number, std::move(**whole));
    }
    if (peer_) host_.lose_parcels(session_, *peer_);
    co_return done;
}

Result<void> DataStream::await_parcel(std::span<const std::byte> payload) {
    const auto awaited = wire::read_awaited(payload);
    if (!awaited) return tl::unexpected(awaited.error());
    if (auto here = awaited_.await(awaited->number, awaited->from, AwaitedParcels::Clock::now())) {
        room_ = batches_->push(std::move(*here));
        return {};
    }
    if (awaited_.too_many()) return wall::fail("more parcels are awaited than a stream may have on their way");
    batches_->push_place(awaited->number);
    return {};
}

void DataStream::take_parcel(std::uint32_t number, RawBytes batch) {
    auto placed = awaited_.take(number, std::move(batch), AwaitedParcels::Clock::now());
    if (placed && batches_->fill(number, std::move(*placed))) host_.render().wake();
}

void DataStream::miss_parcels(const std::function<bool(NodeIndex)>& gone) {
    const bool missed = gone ? awaited_.waits_for(gone) : awaited_.overdue(AwaitedParcels::Clock::now());
    if (!missed || closing_) return;
    log::warn("parcel_missed stream={} session={}", id_.value, session_.value);
    resumable_ = false;
    close();
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
        co_await timer_.async_wait(net::kTuple);
    }
}

// ---- what it sends ----

void DataStream::send(wire::FrameKind kind, std::span<const std::byte> payload) {
    if (closing_) return;
    outgoing_.push_back(std::make_shared<const Outgoing>(wire::whole_frame(kind, payload), is_counted(kind)));
    outgoing_bytes_ += outgoing_.back()->bytes.size();
    if (outgoing_bytes_ > kMaxQueued) return close();
    if (connection_.is_open() && !std::exchange(writing_, true))
        asio::co_spawn(connection_.executor(), write_queue(), asio::detached);
}

asio::awaitable<void> DataStream::write_queue() {
    const auto self = shared_from_this();
    while (!outgoing_.empty()) {
        const auto frame = outgoing_.front();
        outgoing_.pop_front();
        outgoing_bytes_ -= frame->bytes.size();
        keep(frame);
        const auto [error, written] = co_await connection_.write(asio::buffer(frame->bytes));
        if (error || next_) break;
    }
    writing_ = false;
    if (!connection_.is_open()) timer_.cancel();  // wait_for_connection() waits for that, too
    if (closing_) close();
}

/// Until the client says that it has got it.
void DataStream::keep(const std::shared_ptr<const Outgoing>& frame) {
    if (!frame->counted) return;
    if (!resumable_) {
        ++forgotten_;
        return;
    }
    sent_.push_back(frame);
    sent_bytes_ += frame->bytes.size();
    if (sent_bytes_ <= kMostKept) return;
    resumable_ = false;  // a client that does not say what it gets
    forgotten_ += sent_.size();
    sent_.clear();
}

void DataStream::forget_sent(std::uint64_t received) {
    for (; forgotten_ < received && !sent_.empty(); ++forgotten_) {
        sent_bytes_ -= sent_.front()->bytes.size();
        sent_.pop_front();
    }
}

// ---- a connection that is lost ----

Result<void> DataStream::take_receipt(std::span<const std::byte> payload) {
    std::uint64_t received = 0;
    if (payload.size() != sizeof received) return wall::fail("receipt: expected 8 bytes");
    std::memcpy(&received, payload.data(), sizeof received);
    if (received > forgotten_ + sent_.size()) return wall::fail("receipt: for more frames than were sent");
    forget_sent(received);
    return {};
}

void DataStream::send_receipt(std::size_t bytes) {
    receipt_bytes_ += bytes;
    const std::uint64_t frames = source_.batch_frames();
    if (!resumable_ || (receipt_bytes_ < kReceiptBytes && frames - receipt_frames_ < kReceiptFrames)) return;
    receipt_bytes_ = 0;
    receipt_frames_ = frames;
    send(wire::FrameKind::receipt, std::as_bytes(std::span(&frames, 1)));
}

/// Of a client that goes on with a stream: the connection is that one's from now on.
Result<bool> DataStream::hand_over(const proto::DataHello& hello) {
    DataStream* before = host_.stream(StreamId(hello.resume().stream()));
    if (!before || before == this || !before->is_before(*this) || before->rank_ != rank_ ||
        !before->go_on(connection_, hello.resume().received(), hello.resume().attempt()))
        return wall::fail("stream " + std::to_string(hello.resume().stream()) + ", which was to go on, is over");
    return true;
}

bool DataStream::go_on(net::Stream& connection, std::uint64_t received, std::uint64_t attempt) {
    if (!resumable_ || closing_ || attempt <= last_attempt_ || received < forgotten_ ||
        received > forgotten_ + sent_.size())
        return false;
    last_attempt_ = attempt;
    next_.emplace(std::move(connection), received);
    connection_.close();  // if nobody knew yet that it is lost
    timer_.cancel();
    return true;
}

asio::awaitable<Result<void>> DataStream::wait_for_connection() {
    connection_.close();  // a write may still wait
    const auto until = std::chrono::steady_clock::now() + kAwaited;
    while (!closing_ && (!next_ || writing_) && std::chrono::steady_clock::now() < until) {
        timer_.expires_at(until);
        co_await timer_.async_wait(net::kTuple);
    }
    if (closing_ || !next_ || writing_) co_return wall::fail(FrameSource::kClosed);
    connection_ = std::move(next_->stream);
    const auto received = std::exchange(next_, {})->received;
    source_.go_on();
    forget_sent(received);
    std::erase_if(outgoing_, [](const auto& frame) { return !frame->counted; });
    outgoing_.insert(outgoing_.begin(), sent_.begin(), sent_.end());
    sent_.clear();
    sent_bytes_ = 0;
    outgoing_bytes_ = 0;
    for (const auto& frame : outgoing_) outgoing_bytes_ += frame->bytes.size();
    const std::uint64_t frames = source_.batch_frames();
    outgoing_.push_front(std::make_shared<const Outgoing>(
        wire::whole_frame(wire::FrameKind::resumed, std::as_bytes(std::span(&frames, 1))), false));
    outgoing_bytes_ += outgoing_.front()->bytes.size();
    writing_ = true;
    asio::co_spawn(connection_.executor(), write_queue(), asio::detached);
    log::info("stream_resumed stream={} session={}", id_.value, session_.value);
    co_return Result<void>{};
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
