// SPDX-License-Identifier: MIT
#include "client_lib/link/node_stream.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <span>

#include "client_lib/link/node_greeting.h"
#include "client_lib/link/stream_attempts.h"
#include "client_lib/process/log.h"
#include "client_lib/process/stats.h"
#include "common/base/address.h"
#include "common/base/quoted.h"
#include "common/wire/limits.h"
#include "common/wire/padding.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxQueuedBytes = 64u << 20;  // of one node: about two frames of the heaviest programs
constexpr int kStallLimitMs = 5000;                 // a node that takes nothing for so long is given up
constexpr std::size_t kInboxChunk = 64 << 10;
constexpr std::uint64_t kReceiptFrames = 64;                       // that have come since the last receipt
constexpr std::size_t kReceiptBytes = 1 << 20;                     // or bytes of them
constexpr std::size_t kMostSpare = 4;                              // buffers that wait for another batch
constexpr std::size_t kLargestSpare = (std::size_t{5} << 20) / 4;  // bytes of one: a mebibyte of operands, and opcodes

}  // namespace

Result<std::shared_ptr<NodeStream>> NodeStream::open(const std::string& address, const std::string& hello,
                                                     int timeout_ms, bool ring, Coding coding) {
    const auto deadline = Clock::now() + std::chrono::milliseconds(timeout_ms);
    const auto at = Address::parse(address);
    if (!at) return tl::unexpected(at.error());
    // Where the system forbids shared memory to this process, or the node does not take it, the socket will do.
    auto offered =
        ring && at->is_unix() ? wire::RingWriter::create() : Result<wire::RingWriter>(fail("none is wanted"));
    auto greeting = greet_node(address, hello, offered ? offered->descriptor() : -1, deadline);
    if (!greeting) return tl::unexpected(greeting.error());
    const Answer& answer = greeting->answer;
    if (!answer.why.empty()) return fail(answer.why);
    const bool taken = answer.kind == wire::FrameKind::ring && offered;
    if (!taken && answer.kind != wire::FrameKind::welcome)
        return fail("node at " + address + " does not speak this protocol");
    if (taken) offered->close_descriptor();
    return std::shared_ptr<NodeStream>(
        new NodeStream(std::move(greeting->fd), taken ? std::optional(std::move(*offered)) : std::nullopt,
                       static_cast<std::uint32_t>(answer.number), address, hello, coding));
}

template <class Done>
void NodeStream::wait(std::unique_lock<std::mutex>& lock, int timeout_ms, Done&& done) {
    if (timeout_ms == kNoLimit) changed_.wait(lock, done);
    else changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms), done);
}

NodeStream::Outgoing NodeStream::outgoing(ContextId context, wire::PackBuffer batch) {
    const std::size_t padding = wire::padded4(batch.commands()) - batch.commands();
    const wire::BatchHeader header{context, static_cast<std::uint32_t>(batch.commands()),
                                   static_cast<std::uint32_t>(batch.operand_bytes())};
    Outgoing out;
    std::memcpy(out.lead.data(), &header, sizeof header);
    out.lead_bytes = sizeof header + padding;
    out.body = std::move(batch);
    out.plain_bytes = out.lead_bytes + out.body.bytes();
    return out;
}

void NodeStream::send(ContextId context, wire::PackBuffer batch) {
    if (batch.empty() || failed()) return;
    Outgoing out = outgoing(context, std::move(batch));
    if (out.plain_bytes > wire::kMaxBatchPayload)
        return give_up("a batch is larger than one may be");  // checked before
    out.frames = (out.plain_bytes + wire::kPartBytes - 1) / wire::kPartBytes;
    queue(std::move(out));
}

void NodeStream::send_parcel(std::uint32_t number, std::vector<NodeIndex> route, ContextId context,
                             wire::PackBuffer batch) {
    if (batch.empty() || failed()) return;
    Outgoing out = outgoing(context, std::move(batch));
    out.kind = wire::FrameKind::parcel;
    out.parcel.number = number;
    out.parcel.route = std::move(route);
    out.frames = (out.plain_bytes + wire::kParcelPiece - 1) / wire::kParcelPiece;
    queue(std::move(out));
}

void NodeStream::await_parcel(std::uint32_t number, NodeIndex from) {
    if (failed()) return;
    Outgoing out;
    out.kind = wire::FrameKind::awaited;
    const std::array<std::uint32_t, 2> words{number, from.value};
    std::memcpy(out.lead.data(), words.data(), sizeof words);
    out.plain_bytes = out.lead_bytes = sizeof words;
    out.body = wire::PackBuffer(0);
    queue(std::move(out));
}

void NodeStream::queue(Outgoing out) {
    const std::size_t payload = out.plain_bytes;
    out.begin_part(0);

    std::unique_lock lock(mutex_);
    const auto room = [&] { return failed() || queued_bytes_ + sent_bytes_ < kMaxQueuedBytes; };
    while (!room()) {
        if (stalls_ && !connected_) {  // nobody waits for a link that may be gone for long
            lock.unlock();
            return give_up("its connection is lost, and much waits for the next one");
        }
        const std::uint64_t before = bytes_sent();
        wait(lock, stalls_ ? kStallLimitMs : kNoLimit, room);
        if (room() || bytes_sent() != before) continue;
        lock.unlock();
        give_up("node takes no more data");
        return;
    }
    out.first_frame = next_frame_;
    next_frame_ += out.frames;
    queued_bytes_ += payload;
    queue_.push_back(std::move(out));
}

wire::PackBuffer NodeStream::spare() {
    std::lock_guard lock(mutex_);
    if (spare_.empty()) return wire::PackBuffer();
    auto buffer = std::move(spare_.back());
    spare_.pop_back();
    return buffer;
}

/// The smallest that are large enough for most programs' batches; a few, since a few are on their way at a time.
void NodeStream::keep(wire::PackBuffer sent) {
    if (spare_.size() >= kMostSpare || sent.capacity() > kLargestSpare) return;
    sent.clear();
    spare_.push_back(std::move(sent));
}

/// A parcel's are alike: it has as many once it is coded, and is smaller.
std::size_t NodeStream::Outgoing::start_of(std::uint64_t at) const {
    if (kind == wire::FrameKind::parcel) return static_cast<std::size_t>(payload_bytes() * at / frames);
    return std::min(payload_bytes(), static_cast<std::size_t>(at) * wire::kPartBytes);
}

void NodeStream::Outgoing::begin_part(std::uint64_t at) {
    part = at;
    part_start = start_of(at);
    part_bytes = start_of(at + 1) - part_start;
    sent = 0;
    std::vector<std::byte> more;
    auto frame_kind = kind;
    if (kind == wire::FrameKind::parcel) {
        parcel.bytes = static_cast<std::uint32_t>(payload_bytes());
        parcel.plain_bytes = is_coded() ? static_cast<std::uint32_t>(plain_bytes) : 0;
        parcel.offset = static_cast<std::uint32_t>(part_start);
        more = wire::encode_parcel_lead(parcel);
    } else if (kind == wire::FrameKind::batch) {
        frame_kind = at + 1 < frames ? wire::FrameKind::part : is_coded() ? wire::FrameKind::coded : kind;
    }
    const auto header = wire::encode_frame_header({static_cast<std::uint32_t>(more.size() + part_bytes), frame_kind});
    front.assign(header.begin(), header.end());
    front.insert(front.end(), more.begin(), more.end());
}

std::optional<std::vector<std::byte>> NodeStream::wait_reply(RequestId request, int timeout_ms) {
    std::unique_lock lock(mutex_);
    wait(lock, timeout_ms, [&] { return failed() || replies_.contains(request); });
    const auto found = replies_.find(request);
    if (found == replies_.end()) {
        unwanted_.insert(request);
        return std::nullopt;
    }
    auto bytes = std::move(found->second.bytes);
    replies_.erase(found);
    return bytes;
}

bool NodeStream::wait_until_answered(RequestId request, std::chrono::nanoseconds timeout) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, timeout, [&] { return failed() || replies_.contains(request); });
}

std::optional<Clock::time_point> NodeStream::answered_at(RequestId request) const {
    std::lock_guard lock(mutex_);
    const auto found = replies_.find(request);
    return found == replies_.end() ? std::nullopt : std::optional(found->second.at);
}

void NodeStream::forget_request(RequestId request) {
    std::lock_guard lock(mutex_);
    if (replies_.erase(request) == 0) unwanted_.insert(request);
}

bool NodeStream::wait_swap(SurfaceId surface, std::uint32_t frame, int timeout_ms) {
    std::unique_lock lock(mutex_);
    const auto done = [&] {
        const auto found = swaps_.find(surface);
        return found != swaps_.end() && static_cast<std::int32_t>(found->second.frame - frame) >= 0;
    };
    wait(lock, timeout_ms, [&] { return failed() || done(); });
    return done();
}

std::optional<Clock::time_point> NodeStream::last_swap(SurfaceId surface) const {
    std::lock_guard lock(mutex_);
    const auto found = swaps_.find(surface);
    return found == swaps_.end() ? std::nullopt : std::optional(found->second.at);
}

void NodeStream::expect_swap(SurfaceId surface, std::uint32_t frame) {
    std::lock_guard lock(mutex_);
    const auto drawn = swaps_.find(surface);
    if (drawn != swaps_.end() && static_cast<std::int32_t>(drawn->second.frame - frame) >= 0) return;  // it was quick
    owed_[surface] = frame;
    note_waiting();
}

void NodeStream::note_waiting() {
    const bool waits = blocked_ || !owed_.empty();
    if (waits == waits_since_.has_value()) return;
    const auto now = Clock::now();
    if (waits) waits_since_ = now;
    else waited_ += now - *std::exchange(waits_since_, std::nullopt);
}

void NodeStream::set_blocked(bool blocked) {
    if (blocked_ == blocked) return;  // only the transport thread changes it
    std::lock_guard lock(mutex_);
    blocked_ = blocked;
    note_waiting();
}

std::size_t NodeStream::queued_bytes() const {
    std::lock_guard lock(mutex_);
    return queued_bytes_;
}

std::string NodeStream::failure() const {
    std::lock_guard lock(mutex_);
    return failure_;
}

bool NodeStream::wants_write() {
    std::lock_guard lock(mutex_);
    return connected_ && (!queue_.empty() || !control_.empty() || receipt_is_due()) && !failed();
}

/// Opcodes and operands are one run of memory.
NodeStream::Pieces NodeStream::pieces_of(const Outgoing& out) {
    Pieces pieces;
    const auto add = [&](const std::byte* from, std::size_t bytes) {
        if (bytes != 0) pieces.at[pieces.count++] = {const_cast<std::byte*>(from), bytes};
    };
    const std::size_t head = std::min(out.sent, out.front.size());
    add(out.front.data() + head, out.front.size() - head);
    const std::size_t at = out.part_start + (out.sent - head), end = out.part_start + out.part_bytes;
    if (out.is_coded()) return add(out.coded.data() + at, end - at), pieces;
    const std::size_t lead = std::min(at, out.lead_bytes), lead_end = std::min(end, out.lead_bytes);
    add(out.lead.data() + lead, lead_end - lead);
    const std::size_t body = std::max(at, out.lead_bytes), body_end = std::max(end, out.lead_bytes);
    add(out.body.opcodes().data() + (body - out.lead_bytes), body_end - body);
    return pieces;
}

/// Only what is kept until the node has it, and so can be sent again as it was: the node's history goes on where ours
/// does. Streams within a machine have no link.
bool NodeStream::may_be_coded(const Outgoing& out) const {
    return number_ != 0 && choice_.codes() && !cannot_code_ && out.plain_bytes <= wire::kMostCodedBatch &&
           out.kind != wire::FrameKind::awaited;
}

void NodeStream::code(Outgoing& out) {
    const auto begin = Clock::now();
    const bool is_parcel = out.kind == wire::FrameKind::parcel;  // whoever it is handed on to has no history of ours
    std::optional<wire::HistoryEncoder> of_its_own;
    auto& encoder = is_parcel ? of_its_own : encoder_;
    if (!encoder) encoder = wire::HistoryEncoder::create();
    const std::array<std::span<const std::byte>, 2> pieces{std::span(out.lead.data(), out.lead_bytes),
                                                           std::span(out.body.opcodes().data(), out.body.bytes())};
    const auto plain = static_cast<std::uint32_t>(out.plain_bytes);
    const auto head = std::as_bytes(std::span(&plain, 1));
    coding_room_.clear();
    if (!is_parcel) coding_room_.assign(head.begin(), head.end());
    if (!encoder || !encoder->encode(pieces, coding_room_)) {
        cannot_code_ = true;
        return;
    }
    const std::lock_guard lock(mutex_);
    queued_bytes_ -= out.plain_bytes;
    out.coded.assign(coding_room_.begin(), coding_room_.end());  // no larger than it must be: it may wait for long
    queued_bytes_ += out.coded.size();
    keep(std::move(out.body));
    out.begin_part(0);
    choice_.coding_took(Clock::now() - begin);
}

bool NodeStream::write_some(Outgoing& out) {
    for (;;) {
        const Pieces pieces = pieces_of(out);
        if (pieces.count == 0) {
            if (out.part + 1 == out.frames) return true;
            out.begin_part(out.part + 1);
            continue;
        }
        const auto written = ring_ ? write_ring(pieces) : write_socket(pieces);
        if (!written) return false;
        out.sent += *written;
        bytes_sent_.fetch_add(*written, std::memory_order_relaxed);
        if (counted_for_) stats().add_node(*counted_for_, NodeCounter::link_bytes, *written);
    }
}

/// All of a frame in one system call.
std::optional<std::size_t> NodeStream::write_socket(Pieces pieces) {
    msghdr message{};
    message.msg_iov = pieces.at.data();
    message.msg_iovlen = pieces.count;
    for (;;) {
        const ssize_t n = ::sendmsg(fd_.get(), &message, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n >= 0) return static_cast<std::size_t>(n);
        if (errno == EINTR) continue;
        if (errno != EAGAIN) cannot_send();
        return std::nullopt;
    }
}

std::optional<std::size_t> NodeStream::write_ring(const Pieces& pieces) {
    std::size_t written = 0;
    do {
        for (std::size_t i = 0; i < pieces.count; ++i) {
            const std::span piece(static_cast<const std::byte*>(pieces.at[i].iov_base), pieces.at[i].iov_len);
            const std::size_t n = ring_->write(piece);
            written += n;
            if (n < piece.size()) break;
        }
        // A full socket holds signs enough.
        const std::byte sign{};
        if (ring_->reader_waits() && ::send(fd_.get(), &sign, 1, MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno != EAGAIN)
            return cannot_send(), std::nullopt;
        if (ring_->broken()) return give_up("node has broken the ring"), std::nullopt;
    } while (written == 0 && !ring_->wait_for_room());
    return written == 0 ? std::nullopt : std::optional(written);
}

void NodeStream::cannot_send() {
    const std::string why = std::string("cannot send: ") + std::strerror(errno);
    on_readable();  // the node may have said why it closed the stream
    if (connected_) lost(why);
}

/// What is on its way goes out first: nothing stands within a batch. False: not all of it is out.
bool NodeStream::write_receipt() {
    if (control_.empty()) {
        const auto header = wire::encode_frame_header({sizeof received_, wire::FrameKind::receipt});
        const auto frames = std::as_bytes(std::span(&received_, 1));
        control_.assign(header.begin(), header.end());
        control_.insert(control_.end(), frames.begin(), frames.end());
        control_sent_ = 0;
        receipt_for_ = received_;
        unreceipted_bytes_ = 0;
    }
    while (control_sent_ < control_.size()) {
        Pieces rest;
        rest.at[rest.count++] = {control_.data() + control_sent_, control_.size() - control_sent_};
        const auto written = write_socket(rest);
        if (!written) return false;
        control_sent_ += *written;
    }
    control_.clear();
    return true;
}

void NodeStream::on_writable() {
    for (;;) {
        if (!connected_) return;
        Outgoing* front = nullptr;
        {
            std::lock_guard lock(mutex_);
            if (!queue_.empty()) front = &queue_.front();  // only this thread removes, and push_back moves none
        }
        if (!control_.empty() || (receipt_is_due() && !(front && front->has_begun()))) {
            if (!write_receipt()) return;
            continue;
        }
        if (!front) return;
        if (!std::exchange(front->decided, true) && may_be_coded(*front)) code(*front);
        const std::size_t total = front->payload_bytes();
        const bool written = write_some(*front);
        set_blocked(!written);
        if (!written) return;
        std::lock_guard lock(mutex_);
        if (queue_.empty()) return;  // failed meanwhile
        queued_bytes_ -= total;
        if (number_ != 0) {
            sent_bytes_ += total;
            sent_.push_back(std::move(queue_.front()));
        } else {
            keep(std::move(queue_.front().body));
        }
        queue_.pop_front();
        changed_.notify_all();
    }
}

void NodeStream::on_readable() {
    for (;;) {
        if (inbox_.size() - inbox_used_ < kInboxChunk) inbox_.resize(std::max(inbox_.size() * 2, kInboxChunk * 2));
        const ssize_t n = ::recv(fd_.get(), inbox_.data() + inbox_used_, inbox_.size() - inbox_used_, MSG_DONTWAIT);
        if (n == 0) return lost("node closed the stream");
        if (n < 0) {
            if (errno == EINTR) continue;
            if (errno != EAGAIN) lost(std::string("cannot receive: ") + std::strerror(errno));
            return;
        }
        inbox_used_ += static_cast<std::size_t>(n);
        std::size_t at = 0;
        while (inbox_used_ - at >= wire::kFrameHeaderBytes) {
            const auto header = wire::decode_frame_header(inbox_.data() + at);
            if (header.payload_bytes > wire::kMaxFramePayload) return give_up("node sent an oversized frame");
            if (inbox_used_ - at < wire::kFrameHeaderBytes + header.payload_bytes) break;
            const auto* payload = inbox_.data() + at + wire::kFrameHeaderBytes;
            handle_frame(header.kind, {payload, payload + header.payload_bytes});
            at += wire::kFrameHeaderBytes + header.payload_bytes;
        }
        if (at > 0) {
            std::memmove(inbox_.data(), inbox_.data() + at, inbox_used_ - at);
            inbox_used_ -= at;
        }
    }
}

void NodeStream::handle_frame(wire::FrameKind kind, std::vector<std::byte> payload) {
    if (kind == wire::FrameKind::error) {
        ended_by_node_.store(!failed(), std::memory_order_release);
        return give_up("node ended the session: " +
                       std::string(reinterpret_cast<const char*>(payload.data()), payload.size()));
    }
    if (kind == wire::FrameKind::room) return;  // whoever has read it looks what there is to write
    if (kind == wire::FrameKind::begin_again) return begin_again_.store(true, std::memory_order_relaxed);
    if (kind == wire::FrameKind::handed_on || kind == wire::FrameKind::not_handed_on)
        return hear_of_parcel(kind, payload);
    if (kind == wire::FrameKind::receipt && payload.size() == sizeof(std::uint64_t)) {
        std::uint64_t frames = 0;
        std::memcpy(&frames, payload.data(), sizeof frames);
        return take_receipt(frames);
    }
    if (kind != wire::FrameKind::reply && kind != wire::FrameKind::swap_done) return;
    ++received_;
    unreceipted_bytes_ += payload.size();
    std::lock_guard lock(mutex_);
    std::uint32_t words[2];
    if (kind == wire::FrameKind::reply && payload.size() >= 4) {
        std::memcpy(words, payload.data(), 4);
        payload.erase(payload.begin(), payload.begin() + 4);
        if (const RequestId request(words[0]); unwanted_.erase(request) == 0)
            replies_[request] = {std::move(payload), Clock::now()};
    } else if (kind == wire::FrameKind::swap_done && payload.size() == 8) {
        std::memcpy(words, payload.data(), 8);
        const SurfaceId surface(words[0]);
        swaps_[surface] = {words[1], Clock::now()};
        const auto owed = owed_.find(surface);
        if (owed != owed_.end() && static_cast<std::int32_t>(words[1] - owed->second) >= 0) owed_.erase(owed);
        note_waiting();
    }
    changed_.notify_all();
}

void NodeStream::hear_of_parcel(wire::FrameKind kind, std::span<const std::byte> payload) const {
    std::uint32_t word = 0;
    if (!on_parcel_ || payload.size() != sizeof word) return;
    std::memcpy(&word, payload.data(), sizeof word);
    if (kind == wire::FrameKind::handed_on) on_parcel_({.handed_on = word, .missed = {}});
    else on_parcel_({.handed_on = {}, .missed = NodeIndex(word)});
}

bool NodeStream::receipt_is_due() const {
    return number_ != 0 && (received_ - receipt_for_ >= kReceiptFrames || unreceipted_bytes_ >= kReceiptBytes);
}

void NodeStream::take_receipt(std::uint64_t frames) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    const auto waited = waited_ + (waits_since_ ? now - *waits_since_ : Clock::duration());
    while (!sent_.empty() && sent_.front().first_frame + sent_.front().frames <= frames) {
        Outgoing& got = sent_.front();
        sent_bytes_ -= got.payload_bytes();
        choice_.delivered(got.plain_bytes, got.is_coded(), now, waited);
        if (!got.is_coded()) keep(std::move(got.body));
        sent_.pop_front();
    }
    changed_.notify_all();
}

// ---- another connection ----

void NodeStream::lost(const std::string& why) {
    if (number_ == 0 || failed()) return give_up(why);
    log(LogLevel::info, "event=stream_broken stream=%u why=%s", number_, in_quotes(why).c_str());
    fd_.reset();
    inbox_used_ = 0;
    control_.clear();
    attempts_ = StreamAttempts::start({address_, hello_, number_, received_});
    if (!attempts_) return give_up(why);
    const std::lock_guard lock(mutex_);
    connected_ = false;
    changed_.notify_all();
}

void NodeStream::go_on() {
    if (connected_ || !attempts_) return;
    auto outcome = attempts_->take();
    if (!outcome) return;
    attempts_.reset();
    if (!*outcome) return give_up("the connection was lost: " + outcome->error().message);
    fd_ = std::move((*outcome)->fd);
    begin_again((*outcome)->received);
}

/// With what the node has not got.
void NodeStream::begin_again(std::uint64_t received) {
    take_receipt(received);
    const std::lock_guard lock(mutex_);
    for (; !sent_.empty(); sent_.pop_back()) {
        sent_bytes_ -= sent_.back().payload_bytes();
        queued_bytes_ += sent_.back().payload_bytes();
        queue_.push_front(std::move(sent_.back()));
    }
    for (Outgoing& batch : queue_) {
        const std::uint64_t parts = received > batch.first_frame ? received - batch.first_frame : 0;
        if (parts < batch.frames) batch.begin_part(parts);
    }
    receipt_for_ = received_;
    unreceipted_bytes_ = 0;
    connected_ = true;
    log(LogLevel::info, "event=stream_resumed stream=%u", number_);
    changed_.notify_all();
}

NodeStream::~NodeStream() {
    if (attempts_) attempts_->stop();
}

void NodeStream::give_up(const std::string& why) {
    std::lock_guard lock(mutex_);
    if (!failed()) failure_ = why;
    failed_.store(true, std::memory_order_release);
    changed_.notify_all();
}

}  // namespace wall::client
