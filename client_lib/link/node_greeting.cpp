// SPDX-License-Identifier: MIT
#include "client_lib/link/node_greeting.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <vector>

#include "client_lib/link/remaining_time.h"
#include "common/base/address.h"
#include "common/base/connect_within.h"
#include "common/base/descriptor_message.h"
#include "common/wire/frame.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostAnswer = 4096;  // bytes of a reason

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

/// The first bytes of a stream, and with them a descriptor; -1: none.
bool send_first(int fd, std::span<const std::byte> bytes, int descriptor, Clock::time_point deadline) {
    if (descriptor < 0) return write_all(fd, bytes.data(), bytes.size(), deadline);
    for (;;) {
        const ssize_t n = send_with_descriptor(fd, bytes, descriptor);
        if (n >= 0) {
            const auto rest = bytes.subspan(static_cast<std::size_t>(n));
            return write_all(fd, rest.data(), rest.size(), deadline);
        }
        if (errno != EINTR && (errno != EAGAIN || !poll_for(fd, POLLOUT, deadline))) return false;
    }
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

Result<Answer> read_answer(int fd, const std::string& address, Clock::time_point deadline) {
    std::array<std::byte, wire::kFrameHeaderBytes> head;
    if (!read_all(fd, head.data(), head.size(), deadline)) return fail("node at " + address + " does not answer");
    const auto frame = wire::decode_frame_header(head.data());
    Answer answer{frame.kind, 0, {}};
    const bool is_text = frame.kind == wire::FrameKind::error || frame.kind == wire::FrameKind::unreachable;
    std::string payload(std::min<std::size_t>(frame.payload_bytes, kMostAnswer), '\0');
    if (frame.payload_bytes > (is_text ? kMostAnswer : sizeof answer.number) ||
        !read_all(fd, reinterpret_cast<std::byte*>(payload.data()), payload.size(), deadline))
        return fail("node at " + address + " does not speak this protocol");
    if (is_text) answer.why = "node at " + address + " refused: " + payload;
    else std::memcpy(&answer.number, payload.data(), payload.size());
    return answer;
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

Result<Greeting> greet_node(const std::string& address, const std::string& hello, int descriptor,
                            Clock::time_point deadline) {
    auto fd = connect_to(address, remaining_ms(deadline));
    if (!fd) return tl::unexpected(fd.error());
    if (!send_first(fd->get(), wire::whole_frame(wire::FrameKind::hello, std::as_bytes(std::span(hello))), descriptor,
                    deadline))
        return fail("node at " + address + " does not take the hello");
    auto answer = read_answer(fd->get(), address, deadline);
    if (!answer) return tl::unexpected(answer.error());
    return Greeting{std::move(*fd), std::move(*answer)};
}

}  // namespace wall::client
