// SPDX-License-Identifier: MIT
#include "walld/swap_coordinator.h"

#include <algorithm>

namespace wall::walld {

Presents SwapCoordinator::set_nodes(const std::set<std::uint32_t>& nodes, Clock::time_point now) {
    std::erase_if(members_, [&](const auto& m) { return !nodes.contains(m.first); });
    for (const auto node : nodes) members_.try_emplace(node, Member{.waited = presented_ == 0});
    return advance(now);
}

Presents SwapCoordinator::rendered(std::uint32_t node, std::uint32_t frame, Clock::time_point now) {
    const auto found = members_.find(node);
    if (found == members_.end() || frame <= found->second.rendered) return {};
    auto& member = found->second;
    member.rendered = frame;
    if (frame >= presented_) member.waited = true;
    auto out = advance(now);
    // One that comes too late for the group shows what it has: better than nothing, and it frees its buffers.
    if (member.told < member.rendered && member.rendered <= presented_) out.push_back({node, member.told = member.rendered});
    return out;
}

Presents SwapCoordinator::tick(Clock::time_point now) {
    if (!deadline_ || now < *deadline_) return {};
    deadline_.reset();
    ++timeouts_;
    for (auto& [node, member] : members_) {
        if (member.rendered <= presented_) member.waited = false;
    }
    return advance(now);
}

Presents SwapCoordinator::hold(Clock::time_point now) {
    if (!held_) allowed_ = presented_;
    held_ = true;
    return advance(now);
}

Presents SwapCoordinator::step(std::uint32_t frames, Clock::time_point now) {
    allowed_ = std::max(allowed_, presented_) + frames;
    return advance(now);
}

Presents SwapCoordinator::release(Clock::time_point now) {
    held_ = false;
    return advance(now);
}

bool SwapCoordinator::shown(std::uint32_t frame) const {
    return !members_.empty() && std::ranges::all_of(members_, [&](const auto& m) { return m.second.told >= frame; });
}

std::uint32_t SwapCoordinator::ceiling() const { return held_ ? allowed_ : UINT32_MAX; }

/// The last frame that every waited node has rendered.
std::uint32_t SwapCoordinator::agreed() const {
    std::optional<std::uint32_t> least;
    for (const auto& [node, member] : members_) {
        if (member.waited) least = std::min(least.value_or(UINT32_MAX), member.rendered);
    }
    return least.value_or(presented_);
}

bool SwapCoordinator::someone_ahead() const {
    return presented_ < ceiling() && std::ranges::any_of(members_, [&](const auto& m) { return m.second.waited && m.second.rendered > presented_; });
}

Presents SwapCoordinator::advance(Clock::time_point now) {
    Presents out;
    const auto frame = std::min(agreed(), ceiling());
    if (frame > presented_) {
        presented_ = frame;
        deadline_.reset();
        for (auto& [node, member] : members_) {
            const auto upto = std::min(member.rendered, frame);
            if (upto > member.told) out.push_back({node, member.told = upto});
        }
    }
    if (!someone_ahead()) deadline_.reset();
    else if (!deadline_) deadline_ = now + limit_;
    return out;
}

}  // namespace wall::walld
