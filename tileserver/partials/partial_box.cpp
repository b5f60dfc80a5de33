// SPDX-License-Identifier: MIT
#include "tileserver/partials/partial_box.h"

#include <algorithm>

namespace wall::tileserver {

Result<void> PartialBox::put(SessionId session, std::vector<std::byte> message) {
    const auto key = key_of_partial(message);
    if (!key) return tl::unexpected(key.error());
    const std::lock_guard lock(mutex_);
    OfSession& its = sessions_[session];
    its.gone.erase(key->from);
    const auto closed = its.closed.find({key->surface, key->rank});
    if (closed != its.closed.end() && key->sequence <= closed->second) return {};
    if (its.bytes + message.size() > kMostBytes) return fail("more partial pictures than a session may have");
    its.bytes += message.size();
    auto& place = its.messages[*key];
    its.bytes -= place.size();
    place = std::move(message);
    return {};
}

bool PartialBox::has(SessionId session, std::span<const PartialKey> keys) const {
    const std::lock_guard lock(mutex_);
    const auto its = sessions_.find(session);
    return std::ranges::all_of(keys, [&](const PartialKey& key) {
        return its != sessions_.end() && (its->second.messages.contains(key) || its->second.gone.contains(key.from));
    });
}

std::optional<std::vector<std::byte>> PartialBox::take(SessionId session, const PartialKey& key) {
    const std::lock_guard lock(mutex_);
    const auto its = sessions_.find(session);
    if (its == sessions_.end()) return std::nullopt;
    auto node = its->second.messages.extract(key);
    if (node.empty()) return std::nullopt;
    its->second.bytes -= node.mapped().size();
    return std::move(node.mapped());
}

void PartialBox::close(SessionId session, SurfaceId surface, std::uint32_t rank, std::uint32_t sequence) {
    const std::lock_guard lock(mutex_);
    OfSession& its = sessions_[session];
    its.closed[{surface, rank}] = sequence;
    for (auto at = its.messages.begin(); at != its.messages.end();) {
        const PartialKey& key = at->first;
        const bool old = key.surface == surface && key.rank == rank && key.sequence <= sequence;
        if (old) its.bytes -= at->second.size();
        at = old ? its.messages.erase(at) : std::next(at);
    }
}

void PartialBox::lose(SessionId session, NodeIndex from) {
    const std::lock_guard lock(mutex_);
    if (const auto its = sessions_.find(session); its != sessions_.end()) its->second.gone.insert(from);
}

void PartialBox::set_nodes(SessionId session, std::set<NodeIndex> nodes) {
    const std::lock_guard lock(mutex_);
    OfSession& its = sessions_[session];
    for (const NodeIndex before : its.nodes)
        if (!nodes.contains(before)) its.gone.insert(before);
    for (const NodeIndex now : nodes)
        if (!its.nodes.contains(now)) its.gone.erase(now);
    its.nodes = std::move(nodes);
}

void PartialBox::forget(SessionId session) {
    const std::lock_guard lock(mutex_);
    sessions_.erase(session);
}

}  // namespace wall::tileserver
