// SPDX-License-Identifier: MIT
// A blocking control connection for programs that do one thing after the other (wallctl, wallrun, tests). No Asio.
// One thread.
#pragma once

#include <chrono>
#include <optional>

#include "common/base/unique_fd.h"
#include "common/net/address.h"
#include "common/net/framing.h"

namespace wall::net {

class ControlClient {
public:
    static Result<ControlClient> connect(const Address& address, std::chrono::milliseconds timeout);

    Result<void> send(const proto::Envelope& envelope);
    /// The next message, nothing if it has not all come within `timeout`.
    Result<std::optional<proto::Envelope>> poll(std::chrono::milliseconds timeout);
    /// The next message, or an error after `timeout`.
    Result<proto::Envelope> receive(std::chrono::milliseconds timeout);

private:
    explicit ControlClient(UniqueFd fd) : fd_(std::move(fd)) {}
    UniqueFd fd_;
    Unframer unframer_;
};

}  // namespace wall::net
