// SPDX-License-Identifier: MIT
// Sessions that kept a node for themselves and are not let in again at once: for ten seconds, and for twice as long
// each time. Pure; one thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <unordered_map>

#include "common/base/ids.h"

namespace wall::tileserver {

class ShutOut {
public:
    using Clock = std::chrono::steady_clock;

    void blame(SessionId session, Clock::time_point now) {
        Entry& entry = entries_[session];
        entry.time =
            entry.time == Clock::duration::zero() ? kFirst : std::min<Clock::duration>(2 * entry.time, kLongest);
        entry.until = now + entry.time;
    }
    /// For how much longer; nothing: it may come.
    std::optional<std::chrono::seconds> wait(SessionId session, Clock::time_point now) const {
        const auto at = entries_.find(session);
        if (at == entries_.end() || now >= at->second.until) return std::nullopt;
        return std::chrono::ceil<std::chrono::seconds>(at->second.until - now);
    }
    /// The session is over.
    void forget(SessionId session) { entries_.erase(session); }

private:
    static constexpr std::chrono::seconds kFirst{10};
    static constexpr std::chrono::minutes kLongest{10};
    struct Entry {
        Clock::duration time{};
        Clock::time_point until{};
    };
    std::unordered_map<SessionId, Entry> entries_;
};

}  // namespace wall::tileserver
