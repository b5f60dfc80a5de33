// SPDX-License-Identifier: MIT
// How many of something there may be at once: of one peer, and in all, so that nobody takes what others need, and all
// together not what walld has. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "walld/wall/refusal.h"

namespace wall::walld {

struct QuotaLimits {
    const char* what;    ///< "connections to this wall", for the refusal
    std::size_t of_one;  ///< peer
    std::size_t in_all;
};

// What walld allows. LimitNOFILE of walld.service is above the sum of all connections.
inline constexpr QuotaLimits kPeerConnections{"connections to this wall that are no program's and no node's", 512,
                                              2048};
inline constexpr QuotaLimits kHandshakes{"TLS handshakes with this wall", 64, 512};
inline constexpr QuotaLimits kHttpConnections{"HTTP connections to this wall", 512, 1024};
inline constexpr QuotaLimits kForeignHttp{"HTTPS connections to this wall", 64,
                                          512};  ///< of an address of another machine
inline constexpr QuotaLimits kViewers{"live views of this wall", 256, 768};
inline constexpr QuotaLimits kPictures{"pictures of this wall that are being made", 128, 1024};
inline constexpr QuotaLimits kRequests{"requests to this wall that wait for an answer", 128, 1024};

/// What wall.toml allows of one peer.
struct QuotaAllowed {
    std::optional<std::uint32_t> most;  ///< nothing: what there may be
    const char* key = "";               ///< in [quota]
};

class Quota {
    struct Counts {
        std::map<std::string, std::size_t> of;
        std::size_t in_all = 0;
    };

public:
    /// One of those that there may be. It may outlive the Quota.
    class Place {
    public:
        Place() = default;
        Place(Place&& other) noexcept = default;
        Place& operator=(Place&& other) noexcept {
            leave();
            counts_ = std::move(other.counts_);
            who_ = std::move(other.who_);
            return *this;
        }
        ~Place() { leave(); }
        void leave();

    private:
        friend class Quota;
        Place(std::shared_ptr<Counts> counts, std::string who) : counts_(std::move(counts)), who_(std::move(who)) {}
        std::shared_ptr<Counts> counts_;  // null: none
        std::string who_;
    };

    explicit Quota(const QuotaLimits& limits) : limits_(limits) {}

    /// `who`: names the peer, for the refusal as well.
    Outcome<Place> take(const std::string& who, const QuotaAllowed& allowed = {});
    std::size_t in_all() const { return counts_->in_all; }

private:
    QuotaLimits limits_;
    std::shared_ptr<Counts> counts_ = std::make_shared<Counts>();
};

}  // namespace wall::walld
