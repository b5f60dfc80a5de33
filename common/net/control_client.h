// SPDX-License-Identifier: MIT
// A blocking control connection for programs that do one thing after the other (wallctl, wallrun, tests). No Asio.
// One thread.
#pragma once

#include <chrono>
#include <optional>

#include "common/base/unique_fd.h"
#include "common/net/address.h"
#include "common/net/framing.h"
#include "common/net/reply_parts.h"

namespace wall::net {

class ControlClient {
public:
    /// To a process of the user WALLGL_WALLD_USER, of root or of our own user; nothing is said to any other.
    static Result<ControlClient> connect(const Address& address, std::chrono::milliseconds timeout);

    Result<void> send(const proto::Envelope& envelope);
    /// The next message, nothing if it has not all come within `timeout`. An operator's answer that comes in parts is
    /// one message; each part has `timeout` to come.
    Result<std::optional<proto::Envelope>> poll(std::chrono::milliseconds timeout);
    /// The next message, or an error after `timeout`.
    Result<proto::Envelope> receive(std::chrono::milliseconds timeout);

private:
    explicit ControlClient(UniqueFd fd) : fd_(std::move(fd)) {}
    UniqueFd fd_;
    Result<std::optional<proto::Envelope>> next();

    Unframer unframer_;
    ReplyJoiner answer_;
};

}  // namespace wall::net
