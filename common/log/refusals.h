// SPDX-License-Identifier: MIT
// Who was refused something, a line of the daemons' log each: `refused at=control from="10.0.0.7" reason="..."`.
// Whoever comes without end fills no disk with that: after some lines at once there is one now and then, which says how
// many were left out.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace wall::log {

/// What is said, and what is left out. Pure; one thread.
class Refusals {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr unsigned kAtOnce = 20;              ///< lines about one place and one peer
    static constexpr std::chrono::seconds kThenEach{5};  ///< until another line has become free
    static constexpr std::size_t kMostPeers = 256;       ///< that are told apart; others share what is said of them

    /// The line, if it is to be written. `at`: a word, where it was; `from`, `reason`: anybody's text.
    std::optional<std::string> line(std::string_view at, std::string_view from, std::string_view reason,
                                    Clock::time_point now);

private:
    struct Peer {
        unsigned said = 0;  ///< lines that are not yet free again
        Clock::time_point since{};
        std::uint64_t unsaid = 0;
    };
    Peer& peer(std::string_view at, std::string_view from, Clock::time_point now);

    std::map<std::pair<std::string, std::string>, Peer> peers_;
};

/// Writes it as one of this process's. Any thread.
void refused(std::string_view at, std::string_view from, std::string_view reason);

}  // namespace wall::log
