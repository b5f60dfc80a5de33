// SPDX-License-Identifier: MIT
#include "client_lib/connect_attempt.h"

#include <system_error>
#include <thread>
#include <utility>

#include "client_lib/process.h"

namespace wall::client {

std::shared_ptr<ConnectAttempt> ConnectAttempt::start(std::string address, std::string hello, int timeout_ms) {
    auto attempt = std::make_shared<ConnectAttempt>();
    const SignalsBlocked blocked;
    try {
        std::thread([attempt, address = std::move(address), hello = std::move(hello), timeout_ms] {
            auto outcome = NodeStream::open(address, hello, timeout_ms);
            const std::lock_guard lock(attempt->mutex_);
            attempt->outcome_ = std::move(outcome);
        }).detach();
    } catch (const std::system_error&) {
        return nullptr;
    }
    return attempt;
}

std::optional<Result<std::shared_ptr<NodeStream>>> ConnectAttempt::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(outcome_, std::nullopt);
}

}  // namespace wall::client
