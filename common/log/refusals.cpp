// SPDX-License-Identifier: MIT
#include "common/log/refusals.h"

#include <algorithm>
#include <mutex>

#include "common/log/log.h"

namespace wall::log {

std::optional<std::string> Refusals::line(std::string_view at, std::string_view from, std::string_view reason,
                                          Clock::time_point now) {
    Peer& about = peer(at, from, now);
    const auto free = std::min<Clock::rep>(about.said, (now - about.since) / kThenEach);
    about.said -= static_cast<unsigned>(free);
    about.since = about.said == 0 ? now : about.since + kThenEach * free;
    if (about.said == kAtOnce) {
        ++about.unsaid;
        return std::nullopt;
    }
    ++about.said;
    auto out = fmt::format("refused at={} from={} reason={}", at, quoted(from), quoted(reason));
    if (const auto unsaid = std::exchange(about.unsaid, 0); unsaid > 0) out += fmt::format(" unsaid={}", unsaid);
    return out;
}

/// Those of whom nothing was said for long make room for others.
Refusals::Peer& Refusals::peer(std::string_view at, std::string_view from, Clock::time_point now) {
    std::pair key(std::string(at), std::string(from.substr(0, kMaxQuoted)));
    if (const auto known = peers_.find(key); known != peers_.end()) return known->second;
    if (peers_.size() >= kMostPeers)
        std::erase_if(peers_, [&](const auto& entry) { return now - entry.second.since > kThenEach * kAtOnce; });
    if (peers_.size() >= kMostPeers) key.second.clear();
    return peers_.try_emplace(std::move(key), Peer{0, now, 0}).first->second;
}

void refused(std::string_view at, std::string_view from, std::string_view reason) {
    static std::mutex mutex;
    static Refusals refusals;
    const std::lock_guard lock(mutex);
    if (const auto line = refusals.line(at, from, reason, Refusals::Clock::now())) write(Level::warn, *line);
}

}  // namespace wall::log
