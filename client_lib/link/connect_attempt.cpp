// SPDX-License-Identifier: MIT
#include "client_lib/link/connect_attempt.h"

#include <system_error>
#include <thread>
#include <utility>

#include "client_lib/process/process.h"

namespace wall::client {

std::shared_ptr<ConnectAttempt> ConnectAttempt::start(std::string address, std::string hello, int timeout_ms,
                                                      std::function<void()> opened) {
    auto attempt = std::make_shared<ConnectAttempt>();
    const SignalsBlocked blocked;
    try {
        std::thread([attempt, address = std::move(address), hello = std::move(hello), timeout_ms,
                     opened = std::move(opened)] {
            auto outcome = NodeStream::open(address, hello, timeout_ms);
            const bool good = outcome.has_value();
            {
                const std::lock_guard lock(attempt->mutex_);
                attempt->outcome_ = std::move(outcome);
                attempt->done_ = true;
                attempt->changed_.notify_all();
            }
            if (good) opened();
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

void ConnectAttempt::wait_until(std::chrono::steady_clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, deadline, [&] { return done_; });
}

}  // namespace wall::client
