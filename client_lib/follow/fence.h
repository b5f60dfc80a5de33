// SPDX-License-Identifier: MIT
// A mark in the streams to all nodes: when each of them has done what came before it. Packed with the commands around
// it and sent with them, so that it costs no round trip; the answers come by themselves. Made by
// ClientSession::fence(). Any application thread; the session's mutex need not be held.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "client_lib/link/node_stream.h"

namespace wall::client {

class Fence {
public:
    using Clock = std::chrono::steady_clock;
    /// No program sees the end of it; clocks can be added to it.
    static constexpr std::chrono::hours kLongestWait{24};

    Fence() = default;
    Fence(Fence&& other) noexcept = default;
    Fence& operator=(Fence&& other) noexcept {
        parts_.swap(other.parts_);
        return *this;
    }
    ~Fence() {
        for (const Part& part : parts_) part.stream->forget_request(part.request);
    }
    /// One more node that has been asked.
    void add(std::shared_ptr<NodeStream> stream, RequestId request) { parts_.push_back({std::move(stream), request}); }

    /// Waits until all nodes have done what came before; those that are lost count as done. False: the time is over.
    bool wait_until(Clock::time_point deadline) const {
        for (const Part& part : parts_) {
            const auto left = deadline - Clock::now();
            if (!part.stream->wait_until_answered(part.request, left.count() > 0 ? left : Clock::duration::zero()))
                return false;
        }
        return true;
    }
    bool done() const { return wait_until({}); }
    /// The answers that are there, each given once.
    std::vector<std::vector<std::byte>> take_answers() {
        std::vector<std::vector<std::byte>> answers;
        for (const Part& part : std::exchange(parts_, {}))
            if (auto answer = part.stream->wait_reply(part.request, 0)) answers.push_back(std::move(*answer));
        return answers;
    }
    /// When the last answer came; nothing: no node has answered.
    std::optional<Clock::time_point> done_at() const {
        std::optional<Clock::time_point> last;
        for (const Part& part : parts_) {
            const auto at = part.stream->answered_at(part.request);
            if (at && (!last || *at > *last)) last = at;
        }
        return last;
    }

private:
    struct Part {
        std::shared_ptr<NodeStream> stream;
        RequestId request;
    };
    std::vector<Part> parts_;
};

}  // namespace wall::client
