// SPDX-License-Identifier: MIT
// Partial pictures that other nodes have sent, until the stream of their session comes to where they are merged.
// Thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "tileserver/partials/partial_format.h"

namespace wall::tileserver {

class PartialBox {
public:
    /// Of one session: more is not taken. Programs are at most two frames ahead.
    static constexpr std::size_t kMostBytes = std::size_t{1} << 30;

    /// One that comes too late is dropped.
    Result<void> put(SessionId session, std::vector<std::byte> message);
    /// All of these have come, but for those of nodes that are gone: they are not waited for.
    bool has(SessionId session, std::span<const PartialKey> keys) const;
    /// Nothing: it has not come.
    std::optional<std::vector<std::byte>> take(SessionId session, const PartialKey& key);
    /// The window's partial pictures up to that sequence, of that process, are not waited for any more.
    void close(SessionId session, SurfaceId surface, std::uint32_t rank, std::uint32_t sequence);
    void forget(SessionId session);
    /// The node's connection has ended. It is there again when something comes from it. Nothing, if the session has
    /// ended before.
    void lose(SessionId session, NodeIndex from);
    /// The nodes that the session has: those that it had before, and not now, are gone.
    void set_nodes(SessionId session, std::set<NodeIndex> nodes);

private:
    struct OfSession {
        std::map<PartialKey, std::vector<std::byte>> messages;
        std::map<std::pair<SurfaceId, std::uint32_t>, std::uint32_t> closed;  ///< by rank: sequences up to this
        std::set<NodeIndex> nodes, gone;
        std::size_t bytes = 0;
    };

    mutable std::mutex mutex_;
    std::map<SessionId, OfSession> sessions_;
};

}  // namespace wall::tileserver
