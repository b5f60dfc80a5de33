// SPDX-License-Identifier: MIT
#include "common/net/control_client.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/trusted_server.h"
#include "common/net/sockets.h"

namespace wall::net {

Result<ControlClient> ControlClient::connect(const Address& address, std::chrono::milliseconds timeout) {
    auto fd = connect_to(address, timeout);
    if (!fd) return tl::unexpected(fd.error());
    if (const auto trusted = check_server(fd->get(), wall_user_from_environment()); !trusted)
        return fail(address.text() + ": this is not walld: " + trusted.error().message +
                    " (WALLGL_WALLD_USER names walld's user)");
    return ControlClient(std::move(*fd));
}

Result<void> ControlClient::send(const proto::Envelope& envelope) {
    const auto bytes = frame(envelope);
    if (!bytes) return tl::unexpected(bytes.error());
    for (std::size_t sent = 0; sent < bytes->size();) {
        const auto n = ::send(fd_.get(), bytes->data() + sent, bytes->size() - sent, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail(std::string("control: ") + std::strerror(errno));
        sent += static_cast<std::size_t>(n);
    }
    return {};
}

/// The next whole message of what has come.
Result<std::optional<proto::Envelope>> ControlClient::next() {
    for (;;) {
        auto message = unframer_.next();
        if (!message || !*message || !(*message)->has_operator_reply()) return message;
        auto answer = answer_.add(std::move(*(*message)->mutable_operator_reply()));
        if (!answer) return tl::unexpected(answer.error());
        if (!*answer) continue;
        *(*message)->mutable_operator_reply() = std::move(**answer);
        return message;
    }
}

Result<std::optional<proto::Envelope>> ControlClient::poll(std::chrono::milliseconds timeout) {
    using Clock = std::chrono::steady_clock;
    auto until = Clock::now() + timeout;
    for (;;) {
        const auto parts = answer_.parts();
        auto message = next();
        if (!message) return tl::unexpected(message.error());
        if (*message) return std::move(*message);
        if (answer_.parts() != parts) until = Clock::now() + timeout;
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
        pollfd wait{fd_.get(), POLLIN, 0};
        const int ready = ::poll(&wait, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
        if (ready < 0 && errno == EINTR) continue;
        if (ready < 0) return fail(std::string("control: ") + std::strerror(errno));
        if (ready == 0) return std::nullopt;
        const auto room = unframer_.prepare();
        const auto n = ::read(fd_.get(), room.data(), room.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail(std::string("control: ") + std::strerror(errno));
        if (n == 0) return fail("control: the connection was closed");
        unframer_.commit(static_cast<std::size_t>(n));
    }
}

Result<proto::Envelope> ControlClient::receive(std::chrono::milliseconds timeout) {
    auto message = poll(timeout);
    if (!message) return tl::unexpected(message.error());
    if (!*message) return fail("control: no answer within " + std::to_string(timeout.count()) + " ms");
    return std::move(**message);
}

}  // namespace wall::net
