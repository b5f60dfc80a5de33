// SPDX-License-Identifier: MIT
#include "client_lib/link/transport.h"

#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "client_lib/process/process.h"

namespace wall::client {
namespace {

constexpr int kLostMs = 10;  // while a stream waits for another connection

}  // namespace

Transport::Transport(std::function<void()> on_failure)
    : on_failure_(std::move(on_failure)), wake_fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    SignalsBlocked blocked;
    thread_ = std::thread([this] { run(); });
}

Transport::~Transport() {
    stop_ = true;
    wake_pending_ = false;
    wake();
    thread_.join();
}

void Transport::add(std::shared_ptr<NodeStream> stream) {
    std::lock_guard lock(mutex_);
    streams_.push_back(std::move(stream));
    wake();
}

void Transport::remove(const NodeStream* stream) {
    std::lock_guard lock(mutex_);
    std::erase_if(streams_, [&](const auto& s) { return s.get() == stream; });
}

void Transport::give_up_all(const std::string& why) {
    std::lock_guard lock(mutex_);
    for (const auto& stream : streams_) stream->give_up(why);
}

void Transport::wake() {
    if (wake_pending_.exchange(true)) return;
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto n = ::write(wake_fd_.get(), &one, sizeof one);
}

void Transport::drain(int timeout_ms) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
    const auto busy = [&] {
        std::lock_guard lock(mutex_);
        return std::any_of(streams_.begin(), streams_.end(), [](auto& s) { return s->wants_write(); });
    };
    while (busy() && std::chrono::steady_clock::now() < deadline) {
        wake();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void Transport::run() {
    std::vector<std::shared_ptr<NodeStream>> streams;
    std::vector<pollfd> fds;
    while (!stop_) {
        bool some_failed = false;
        {
            std::lock_guard lock(mutex_);
            some_failed = std::erase_if(streams_, [](const auto& s) { return s->failed(); }) > 0;
            streams = streams_;
        }
        if (some_failed) on_failure_();
        bool some_lost = false;
        for (auto& stream : streams) {
            stream->go_on();
            some_lost |= stream->fd() < 0;
        }
        fds.assign(1, pollfd{wake_fd_.get(), POLLIN, 0});
        for (auto& stream : streams)
            fds.push_back({stream->fd(), static_cast<short>(POLLIN | (stream->waits_for_socket() ? POLLOUT : 0)), 0});
        if (::poll(fds.data(), fds.size(), some_lost ? kLostMs : 1000) < 0) continue;
        if (fds[0].revents) {
            std::uint64_t count;
            [[maybe_unused]] const auto n = ::read(wake_fd_.get(), &count, sizeof count);
            wake_pending_ = false;  // behind the read, which would take a later wake's count with it
        }
        for (std::size_t i = 0; i < streams.size(); ++i) {
            const auto events = fds[i + 1].revents;
            if (events & (POLLIN | POLLHUP | POLLERR)) streams[i]->on_readable();
            if (!streams[i]->failed() && streams[i]->wants_write()) streams[i]->on_writable();
        }
    }
}

}  // namespace wall::client
