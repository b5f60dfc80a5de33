// SPDX-License-Identifier: MIT
#include "client_lib/link/walld_greeting.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>

#include <utility>

#include "client_lib/link/node_greeting.h"
#include "client_lib/link/remaining_time.h"
#include "common/base/address.h"
#include "common/base/trusted_server.h"
#include "common/wire/limits.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kLengthBytes = 4;  // in front of every envelope, little endian
constexpr std::size_t kReadChunk = 16 << 10;

std::uint32_t framed_size(const std::string& in) {
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < kLengthBytes; ++i) size |= std::uint32_t{static_cast<unsigned char>(in[i])} << 8 * i;
    return size;
}

Result<void> send_all(int fd, const std::string& bytes, Clock::time_point deadline) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
        const ssize_t n = ::send(fd, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n > 0) {
            sent += static_cast<std::size_t>(n);
            continue;
        }
        if (errno == EINTR) continue;
        pollfd p{fd, POLLOUT, 0};
        if (errno != EAGAIN) return fail(strerror(errno));
        if (::poll(&p, 1, remaining_ms(deadline)) == 0) return fail("no answer in time");
    }
    return {};
}

Result<FromWalld> receive_message(int fd, std::string& inbox, Clock::time_point deadline) {
    for (;;) {
        auto message = cut_message(inbox);
        if (!message) return tl::unexpected(message.error());
        if (*message) return std::move(**message);
        pollfd p{fd, POLLIN, 0};
        if (::poll(&p, 1, remaining_ms(deadline)) == 0) return fail("no answer in time");
        const auto more = receive_some(fd, inbox);
        if (!more) return tl::unexpected(more.error());
        if (!*more) return fail("closed the connection");
    }
}

}  // namespace

void append_framed(std::string& out, const std::string& envelope) {
    const auto size = static_cast<std::uint32_t>(envelope.size());
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(size >> shift & 0xff));
    out += envelope;
}

Result<std::optional<FromWalld>> cut_message(std::string& inbox) {
    if (inbox.size() < kLengthBytes) return std::nullopt;
    const auto size = framed_size(inbox);
    if (size > wire::kMaxControlMessage) return fail("oversized message from walld");
    if (inbox.size() - kLengthBytes < size) return std::nullopt;
    auto message = decode_from_walld(std::string_view(inbox).substr(kLengthBytes, size));
    inbox.erase(0, kLengthBytes + size);
    if (!message) return tl::unexpected(message.error());
    return std::optional<FromWalld>(std::move(*message));
}

Result<bool> receive_some(int fd, std::string& inbox) {
    char chunk[kReadChunk];
    const ssize_t n = ::recv(fd, chunk, sizeof chunk, MSG_DONTWAIT);
    if (n > 0) inbox.append(chunk, static_cast<std::size_t>(n));
    if (n == 0) return false;
    if (n < 0 && errno != EAGAIN && errno != EINTR) return fail(strerror(errno));
    return true;
}

Result<Greeted> greet(const Hello& hello, const std::string& address, milliseconds limit) {
    const auto deadline = Clock::now() + limit;
    auto fd = connect_to(address, static_cast<int>(limit.count()));
    if (!fd)
        return fail("the wall is not there: " + fd.error().message +
                    " (is walld running? WALLGL_WALLD names its address)");
    if (auto trusted = check_server(fd->get(), wall_user_from_environment()); !trusted)
        return fail("walld at " + address + " is not walld: " + trusted.error().message +
                    " (WALLGL_WALLD_USER names walld's user)");
    Greeted greeted{std::move(*fd), {}, {}, {}};
    std::string bytes;
    append_framed(bytes, encode(hello));
    if (auto sent = send_all(greeted.fd.get(), bytes, deadline); !sent)
        return fail("walld at " + address + ": " + sent.error().message);
    auto answer = receive_message(greeted.fd.get(), greeted.rest, deadline);
    if (!answer) return fail("walld at " + address + ": " + answer.error().message);
    if (const auto* refused = std::get_if<Refused>(&*answer)) {
        if (!refused->over) return fail("walld at " + address + " refused: " + refused->reason);
        greeted.over = refused->reason;
        return greeted;
    }
    auto* welcome = std::get_if<Welcome>(&*answer);
    if (!welcome) return fail("walld at " + address + " does not speak this protocol");
    greeted.welcome = std::move(*welcome);
    return greeted;
}

}  // namespace wall::client
