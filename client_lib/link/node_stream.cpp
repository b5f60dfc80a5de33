// SPDX-License-Identifier: MIT
#include "client_lib/link/node_stream.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "common/base/address.h"
#include "common/base/connect_within.h"
#include "common/wire/limits.h"
#include "common/wire/padding.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxQueuedBytes = 64u << 20;  // of one node: about two frames of the heaviest programs
constexpr int kStallLimitMs = 5000;                 // a node that takes nothing for so long is given up
constexpr std::size_t kReadChunk = 64 << 10;

int remaining_ms(Clock::time_point deadline) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    return left > 0 ? static_cast<int>(left) : 0;
}

bool poll_for(int fd, short events, Clock::time_point deadline) {
    pollfd p{fd, events, 0};
    for (;;) {
        const int n = ::poll(&p, 1, remaining_ms(deadline));
        if (n > 0) return true;
        if (n == 0 || errno != EINTR) return false;
    }
}

Result<UniqueFd> start_connect(const SocketAddress& to, const std::string& text, Clock::time_point deadline) {
    UniqueFd fd(::socket(to.family(), SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd) return fail("cannot make a socket: " + std::string(std::strerror(errno)));
    const int error = connect_within(fd.get(), to.get(), to.length, deadline);
    if (error == ETIMEDOUT) return fail("no answer from " + text);
    if (error != 0) return fail("cannot connect to " + text + ": " + std::strerror(error));
    return fd;
}

bool write_all(int fd, const std::byte* data, std::size_t size, Clock::time_point deadline) {
    while (size > 0) {
        const ssize_t n = ::send(fd, data, size, MSG_NOSIGNAL);
        if (n > 0) {
            data += n;
            size -= static_cast<std::size_t>(n);
        } else if (n < 0 && errno == EAGAIN) {
            if (!poll_for(fd, POLLOUT, deadline)) return false;
        } else if (n < 0 && errno != EINTR) {
            return false;
        }
    }
    return true;
}

bool read_all(int fd, std::byte* data, std::size_t size, Clock::time_point deadline) {
    while (size > 0) {
        const ssize_t n = ::recv(fd, data, size, 0);
        if (n > 0) {
            data += n;
            size -= static_cast<std::size_t>(n);
        } else if (n == 0) {
            return false;
        } else if (errno == EAGAIN) {
            if (!poll_for(fd, POLLIN, deadline)) return false;
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

}  // namespace

Result<UniqueFd> connect_to(const std::string& address, int timeout_ms) {
    const auto deadline = Clock::now() + std::chrono::milliseconds(timeout_ms);
    const auto parsed = Address::parse(address);
    if (!parsed) return tl::unexpected(parsed.error());
    const auto to = resolve(*parsed);
    if (!to) return tl::unexpected(to.error());
    auto fd = start_connect(*to, address, deadline);
    const int one = 1;
    if (fd && !parsed->is_unix()) ::setsockopt(fd->get(), IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    return fd;
}

Result<std::shared_ptr<NodeStream>> NodeStream::open(const std::string& address, const std::string& hello,
                                                     int timeout_ms) {
    const auto deadline = Clock::now() + std::chrono::milliseconds(timeout_ms);
    auto fd = connect_to(address, timeout_ms);
    if (!fd) return tl::unexpected(fd.error());
    const auto header = wire::encode_frame_header({static_cast<std::uint32_t>(hello.size()), wire::FrameKind::hello});
    if (!write_all(fd->get(), header.data(), header.size(), deadline) ||
        !write_all(fd->get(), reinterpret_cast<const std::byte*>(hello.data()), hello.size(), deadline))
        return fail("node at " + address + " does not take the hello");
    std::array<std::byte, wire::kFrameHeaderBytes> answer;
    if (!read_all(fd->get(), answer.data(), answer.size(), deadline))
        return fail("node at " + address + " does not answer");
    const auto frame = wire::decode_frame_header(answer.data());
    if (frame.kind == wire::FrameKind::error && frame.payload_bytes < 4096) {
        std::string text(frame.payload_bytes, '\0');
        read_all(fd->get(), reinterpret_cast<std::byte*>(text.data()), text.size(), deadline);
        return fail("node at " + address + " refused: " + text);
    }
    if (frame.kind != wire::FrameKind::welcome || frame.payload_bytes != 0)
        return fail("node at " + address + " does not speak this protocol");
    return std::shared_ptr<NodeStream>(new NodeStream(std::move(*fd)));
}

template <class Done>
void NodeStream::wait(std::unique_lock<std::mutex>& lock, int timeout_ms, Done&& done) {
    if (timeout_ms == kNoLimit) changed_.wait(lock, done);
    else changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms), done);
}

void NodeStream::send(ContextId context, wire::PackBuffer batch) {
    if (batch.empty() || failed()) return;
    const std::size_t padding = wire::padded4(batch.commands()) - batch.commands();
    const wire::BatchHeader header{context, static_cast<std::uint32_t>(batch.commands()),
                                   static_cast<std::uint32_t>(batch.operand_bytes())};
    Outgoing out;
    out.lead = {};
    std::memcpy(out.lead.data(), &header, sizeof header);
    out.lead_bytes = sizeof header + padding;
    out.body = std::move(batch);
    const std::size_t payload = out.payload_bytes();
    if (payload > wire::kMaxBatchPayload) return give_up("a batch is larger than one may be");  // checked before
    out.begin_part(0);

    std::unique_lock lock(mutex_);
    const auto room = [&] { return failed() || queued_bytes_ < kMaxQueuedBytes; };
    while (!room()) {
        const std::uint64_t before = bytes_sent();
        wait(lock, stalls_ ? kStallLimitMs : kNoLimit, room);
        if (room() || bytes_sent() != before) continue;
        lock.unlock();
        give_up("node takes no more data");
        return;
    }
    queued_bytes_ += payload;
    queue_.push_back(std::move(out));
}

void NodeStream::Outgoing::begin_part(std::size_t start) {
    part_start = start;
    part_bytes = std::min(payload_bytes() - start, wire::kPartBytes);
    const bool last = start + part_bytes == payload_bytes();
    frame = wire::encode_frame_header(
        {static_cast<std::uint32_t>(part_bytes), last ? wire::FrameKind::batch : wire::FrameKind::part});
    sent = 0;
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
        return found != swaps_.end() && static_cast<std::int32_t>(found->second - frame) >= 0;
    };
    wait(lock, timeout_ms, [&] { return failed() || done(); });
    return done();
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
    return !queue_.empty() && !failed();
}

// All of a frame goes out in one system call; opcodes and operands are one run of memory.
bool NodeStream::write_some(Outgoing& out) {
    for (;;) {
        std::array<iovec, 3> pieces;
        std::size_t count = 0;
        const auto add = [&](const std::byte* from, std::size_t bytes) {
            if (bytes != 0) pieces[count++] = {const_cast<std::byte*>(from), bytes};
        };
        const std::size_t head = std::min(out.sent, out.frame.size());
        add(out.frame.data() + head, out.frame.size() - head);
        const std::size_t at = out.part_start + (out.sent - head), end = out.part_start + out.part_bytes;
        const std::size_t lead = std::min(at, out.lead_bytes), lead_end = std::min(end, out.lead_bytes);
        add(out.lead.data() + lead, lead_end - lead);
        const std::size_t body = std::max(at, out.lead_bytes), body_end = std::max(end, out.lead_bytes);
        add(out.body.opcodes().data() + (body - out.lead_bytes), body_end - body);
        if (count == 0) {
            if (end == out.payload_bytes()) return true;
            out.begin_part(end);
            continue;
        }
        msghdr message{};
        message.msg_iov = pieces.data();
        message.msg_iovlen = count;
        const ssize_t n = ::sendmsg(fd_.get(), &message, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n < 0) {
            if (errno == EINTR) continue;
            if (errno == EAGAIN) return false;
            const std::string why = std::string("cannot send: ") + std::strerror(errno);
            on_readable();  // the node may have said why it closed the stream
            give_up(why);
            return false;
        }
        out.sent += static_cast<std::size_t>(n);
        bytes_sent_.fetch_add(static_cast<std::uint64_t>(n), std::memory_order_relaxed);
    }
}

void NodeStream::on_writable() {
    for (;;) {
        Outgoing* front = nullptr;
        {
            std::lock_guard lock(mutex_);
            if (queue_.empty()) return;
            front = &queue_.front();  // only this thread removes, and deque keeps references on push_back
        }
        const std::size_t total = front->payload_bytes();
        if (!write_some(*front)) return;
        std::lock_guard lock(mutex_);
        if (queue_.empty()) return;  // failed meanwhile
        queued_bytes_ -= total;
        queue_.pop_front();
        changed_.notify_all();
    }
}

void NodeStream::on_readable() {
    for (;;) {
        if (inbox_.size() - inbox_used_ < kReadChunk) inbox_.resize(std::max(inbox_.size() * 2, kReadChunk * 2));
        const ssize_t n = ::recv(fd_.get(), inbox_.data() + inbox_used_, inbox_.size() - inbox_used_, MSG_DONTWAIT);
        if (n == 0) return give_up("node closed the stream");
        if (n < 0) {
            if (errno == EINTR) continue;
            if (errno != EAGAIN) give_up(std::string("cannot receive: ") + std::strerror(errno));
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
    std::lock_guard lock(mutex_);
    std::uint32_t words[2];
    if (kind == wire::FrameKind::reply && payload.size() >= 4) {
        std::memcpy(words, payload.data(), 4);
        payload.erase(payload.begin(), payload.begin() + 4);
        if (const RequestId request(words[0]); unwanted_.erase(request) == 0)
            replies_[request] = {std::move(payload), Clock::now()};
    } else if (kind == wire::FrameKind::swap_done && payload.size() == 8) {
        std::memcpy(words, payload.data(), 8);
        swaps_[SurfaceId(words[0])] = words[1];
    }
    changed_.notify_all();
}

void NodeStream::give_up(const std::string& why) {
    std::lock_guard lock(mutex_);
    if (!failed()) failure_ = why;
    failed_.store(true, std::memory_order_release);
    changed_.notify_all();
}

}  // namespace wall::client
