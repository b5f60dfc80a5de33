// SPDX-License-Identifier: MIT
#include "walld/wall/swap_coordinator.h"

#include <algorithm>

namespace wall::walld {

Presents SwapCoordinator::set_nodes(const std::set<NodeIndex>& nodes, Clock::time_point now) {
    std::erase_if(members_, [&](const auto& m) { return !m.second.leaving() && !nodes.contains(m.first); });
    for (const auto node : nodes) members_.try_emplace(node, Member{.waited = presented_ == 0});
    return advance(now);
}

Presents SwapCoordinator::move(const std::set<NodeIndex>& nodes, std::uint32_t frame, Clock::time_point now) {
    const auto first = std::max(frame, presented_ + 1);
    for (auto& [node, member] : members_) {
        auto& stays = member.stays;
        if (nodes.contains(node) && member.leaving()) stays.push_back({first, UINT32_MAX});
        if (!nodes.contains(node) && !member.leaving()) stays.back().until = first - 1;
        std::erase_if(stays, [](const Stay& stay) { return stay.until < stay.from; });  // two moves before one frame
    }
    std::erase_if(members_, [](const auto& m) { return m.second.stays.empty(); });
    for (const auto node : nodes) members_.try_emplace(node, Member{.stays = {{first, UINT32_MAX}}});
    return advance(now);
}

Presents SwapCoordinator::lose(NodeIndex node, Clock::time_point now) {
    members_.erase(node);
    return advance(now);
}

Presents SwapCoordinator::rendered(NodeIndex node, std::uint32_t frame, Clock::time_point now) {
    const auto found = members_.find(node);
    if (found == members_.end() || frame <= found->second.rendered) return {};
    auto& member = found->second;
    const bool blocked = blocks(member);
    member.draw(member.rendered, frame);
    if (frame >= presented_) member.waited = true;
    rendered_spread_.note(frame, group_of(frame), now);
    blocking_ = blocking_ + (blocks(member) ? 1 : 0) - (blocked ? 1 : 0);
    if (held_ || blocking_ == 0 || member.shows(presented_) > member.told) return advance(now);
    // The group cannot go on, as with all but the last of a thousand reports of a frame.
    if (!deadline_ && member.waited && member.rendered > presented_) deadline_ = now + limit_;
    return {};
}

Presents SwapCoordinator::resume(NodeIndex node, std::uint32_t frame, std::uint32_t shown, Clock::time_point now) {
    const auto found = members_.find(node);
    if (found == members_.end()) return {};
    presented_ = std::max(presented_, shown);
    if (held_) allowed_ = std::max(allowed_, presented_);
    auto& member = found->second;
    member.told = std::max(member.told, shown);
    if (frame > member.rendered) member.draw(shown, frame);
    if (member.rendered >= presented_) member.waited = true;
    return advance(now);
}

Presents SwapCoordinator::tick(Clock::time_point now) {
    if (!deadline_ || now < *deadline_) return {};
    deadline_.reset();
    ++timeouts_;
    for (auto& [node, member] : members_) {
        if (member.cap() <= presented_) member.waited = false;
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
    if (presented_ < frame || members_.empty()) return false;
    return std::ranges::all_of(members_,
                               [&](const auto& m) { return !m.second.takes_part(frame) || m.second.told >= frame; });
}

std::uint32_t SwapCoordinator::behind(NodeIndex node) const {
    const auto found = members_.find(node);
    if (found == members_.end()) return 0;
    const Stay& stay = found->second.stays.back();
    const auto shown = std::max(found->second.told, stay.from > 0 ? stay.from - 1 : 0),
               due = std::min(presented_, stay.until);
    return due > shown ? due - shown : 0;
}

std::uint32_t SwapCoordinator::ceiling() const { return held_ ? allowed_ : UINT32_MAX; }

bool SwapCoordinator::Member::takes_part(std::uint32_t frame) const {
    return std::ranges::any_of(stays, [&](const Stay& stay) { return frame >= stay.from && frame <= stay.until; });
}

std::uint32_t SwapCoordinator::Member::cap() const {
    const auto stay = std::ranges::find_if(stays, [&](const Stay& s) { return rendered < s.until; });
    if (stay == stays.end()) return UINT32_MAX;
    return std::max(rendered, stay->from > 0 ? stay->from - 1 : 0);
}

/// `last`: what it had before.
void SwapCoordinator::Member::draw(std::uint32_t last, std::uint32_t frame) {
    missed_from = last + 1;
    missed_until = rendered = frame;
}

std::uint32_t SwapCoordinator::Member::shows(std::uint32_t frame) const {
    const auto newest = std::min(rendered, frame);
    return missed(newest) ? missed_from - 1 : newest;
}

void SwapCoordinator::allow_what_all_can_show() {
    if (!held_) return;
    for (const auto& [node, member] : members_)
        if (member.takes_part(presented_) && member.missed(presented_)) allowed_ = std::max(allowed_, member.rendered);
}

/// The last frame that every waited node has rendered as far as it takes part.
std::uint32_t SwapCoordinator::agreed() const {
    std::uint32_t least = UINT32_MAX, most = presented_;
    for (const auto& [node, member] : members_) {
        if (member.waited) least = std::min(least, member.cap());
        most = std::max(most, member.rendered);
    }
    const bool nobody = std::ranges::none_of(members_, [](const auto& m) { return m.second.waited; });
    return nobody ? presented_ : std::min(least, most);
}

bool SwapCoordinator::someone_ahead() const {
    return presented_ < ceiling() && std::ranges::any_of(members_, [&](const auto& m) {
               return m.second.waited && m.second.rendered > presented_;
           });
}

std::size_t SwapCoordinator::group_of(std::uint32_t frame) {
    Group& known = groups_[frame % groups_.size()];
    if (known.size == 0 || known.frame != frame) known = {frame, count_group(frame)};
    return known.size;
}

std::size_t SwapCoordinator::count_group(std::uint32_t frame) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(members_, [&](const auto& m) { return m.second.takes_part(frame); }));
}

void SwapCoordinator::count_frame(Clock::time_point now) {
    if (last_present_)
        interval_ += (Spread::Milliseconds(now - *last_present_) - interval_) /
                     (interval_.count() == 0 ? 1 : Spread::kMeanFrames);
    last_present_ = now;
}

void SwapCoordinator::tell(Presents& out, NodeIndex node, Member& member, std::uint32_t frame, Clock::time_point now) {
    if (frame <= member.told) return;
    out.push_back({node, member.told = frame});
    presented_spread_.note(frame, group_of(frame), now);
}

/// Not before a node has shown its last frame of a stay: it could draw no other one.
void SwapCoordinator::forget_past() {
    std::size_t forgotten = 0;
    for (auto& [node, member] : members_) {
        forgotten += std::erase_if(
            member.stays, [&](const Stay& stay) { return stay.until <= presented_ && member.told >= stay.until; });
    }
    if (forgotten == 0) return;
    groups_ = {};
    std::erase_if(members_, [](const auto& m) { return m.second.stays.empty(); });
}

Presents SwapCoordinator::advance(Clock::time_point now) {
    Presents out;
    groups_ = {};
    allow_what_all_can_show();
    const auto frame = std::min(agreed(), ceiling());
    if (frame > presented_) {
        presented_ = frame;
        deadline_.reset();
        count_frame(now);
    }
    // One that comes too late for the group shows what it has: better than nothing, and it frees its buffers. However
    // that has become known: a node waits for the word, also while the group is held.
    for (auto& [node, member] : members_)
        if (const auto due = member.shows(presented_); member.takes_part(due)) tell(out, node, member, due, now);
    forget_past();
    if (!someone_ahead()) deadline_.reset();
    else if (!deadline_) deadline_ = now + limit_;
    blocking_ =
        static_cast<std::size_t>(std::ranges::count_if(members_, [&](const auto& m) { return blocks(m.second); }));
    return out;
}

}  // namespace wall::walld
