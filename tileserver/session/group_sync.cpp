// SPDX-License-Identifier: MIT
#include "tileserver/session/group_sync.h"

#include <algorithm>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr std::int64_t kMaxValue = std::int64_t{1} << 31;  // of a semaphore, and of what is missing from it

std::string rank_text(Rank rank) { return "rank " + std::to_string(rank); }

Result<void> unknown(const char* what, std::uint32_t name) {
    return fail(std::string(what) + " " + std::to_string(name) + " does not exist");
}

Result<void> other_count(const char* what, std::uint32_t name, std::uint32_t before, Rank rank, std::uint32_t now) {
    return fail(std::string(what) + " " + std::to_string(name) + " was created with count " + std::to_string(before) +
                ", by " + rank_text(rank) + " with count " + std::to_string(now));
}

}  // namespace

GroupSync::GroupSync(std::uint32_t size, const std::set<Rank>& gone) : members_(size) {
    for (const Rank rank : gone)
        if (rank < size) members_[rank].state = State::left;
}

std::vector<FinishedFrame> GroupSync::take_finished() { return std::exchange(finished_, {}); }

std::optional<std::string> GroupSync::deadlock() const {
    std::string text;
    for (Rank rank = 0; rank < size(); ++rank) {
        const Member& member = members_[rank];
        if (member.state == State::left) continue;
        if (member.state != State::waiting || member.reason == Reason::join) return std::nullopt;
        text += (text.empty() ? "" : ", ") + rank_text(rank) + waiting_text(rank);
    }
    if (text.empty()) return std::nullopt;
    return "no process of the parallel program can go on: " + text;
}

std::string GroupSync::waiting_text(Rank rank) const {
    const Member& member = members_[rank];
    switch (member.reason) {
        case Reason::join: return " waits for the others to come";
        case Reason::barrier: return " waits in barrier " + std::to_string(member.name);
        case Reason::semaphore: return " waits for semaphore " + std::to_string(member.name);
        case Reason::swap:
            return " has ended frame " + std::to_string(member.frame) + " of window " + std::to_string(member.name);
    }
    return {};
}

// ---- members ----

Result<void> GroupSync::running(Rank rank) const {
    if (members_[rank].state == State::running) return {};
    return fail(rank_text(rank) + " has not joined its group, or has left it");
}

void GroupSync::hold(Rank rank, Reason reason, std::uint32_t name, std::uint32_t frame) {
    members_[rank] = {State::waiting, true, reason, name, frame};
}

std::uint32_t GroupSync::possible(const std::set<Rank>& without) const {
    std::uint32_t count = 0;
    for (Rank rank = 0; rank < size(); ++rank) count += members_[rank].state != State::left && !without.contains(rank);
    return count;
}

Result<void> GroupSync::join(Rank rank) {
    if (members_[rank].state != State::absent) return fail(rank_text(rank) + " is here already");
    hold(rank, Reason::join, 0);
    release_joined();
    return {};
}

void GroupSync::release_joined() {
    if (std::ranges::any_of(members_, [](const Member& m) { return m.state == State::absent; })) return;
    for (Rank rank = 0; rank < size(); ++rank)
        if (waits(rank) && members_[rank].reason == Reason::join) release(rank);
}

Result<void> GroupSync::leave(Rank rank) {
    if (left(rank) || waits(rank)) return fail(rank_text(rank) + " cannot leave");
    members_[rank].state = State::left;
    release_joined();
    for (auto& [name, barrier] : barriers_) release_ready(barrier);
    for (auto& [surface, frames] : surfaces_) release_ready(surface, frames);
    return {};
}

// ---- barriers ----

Result<void> GroupSync::barrier_create(Rank rank, std::uint32_t name, std::uint32_t count) {
    if (name == 0 || count == 0 || count > size())
        return fail("barrier " + std::to_string(name) + " of " + std::to_string(count) + " members");
    const auto [at, made] = barriers_.try_emplace(name, Barrier{count, {}, {}});
    if (barriers_.size() > kMaxObjects) return fail("too many barriers");
    if (at->second.count != count) return other_count("barrier", name, at->second.count, rank, count);
    at->second.destroyed.erase(rank);
    return {};
}

Result<void> GroupSync::barrier_destroy(Rank rank, std::uint32_t name) {
    const auto at = barriers_.find(name);
    if (at == barriers_.end()) return unknown("barrier", name);
    at->second.destroyed.insert(rank);
    release_ready(at->second);
    if (possible(at->second.destroyed) == 0) barriers_.erase(at);
    return {};
}

Result<void> GroupSync::barrier_exec(Rank rank, std::uint32_t name) {
    if (auto good = running(rank); !good) return good;
    const auto at = barriers_.find(name);
    if (at == barriers_.end() || at->second.destroyed.contains(rank)) return unknown("barrier", name);
    hold(rank, Reason::barrier, name);
    at->second.inside.insert(rank);
    release_ready(at->second);
    return {};
}

void GroupSync::release_ready(Barrier& barrier) {
    if (barrier.inside.empty() || barrier.inside.size() < std::min(barrier.count, possible(barrier.destroyed))) return;
    for (const Rank rank : std::exchange(barrier.inside, {})) release(rank);
}

// ---- semaphores ----

Result<void> GroupSync::semaphore_create(Rank rank, std::uint32_t name, std::uint32_t count, std::int32_t moved) {
    if (name == 0 || count >= kMaxValue)
        return fail("semaphore " + std::to_string(name) + " of " + std::to_string(count));
    const auto [at, made] = semaphores_.try_emplace(name, Semaphore{count, count, {}, {}});
    if (semaphores_.size() > kMaxObjects) return fail("too many semaphores");
    auto& semaphore = at->second;
    if (semaphore.count != count) return other_count("semaphore", name, semaphore.count, rank, count);
    semaphore.destroyed.erase(rank);
    semaphore.value = std::clamp(semaphore.value + moved, -kMaxValue, kMaxValue);
    release_ready(semaphore);
    return {};
}

Result<void> GroupSync::semaphore_destroy(Rank rank, std::uint32_t name) {
    const auto at = semaphores_.find(name);
    if (at == semaphores_.end()) return unknown("semaphore", name);
    at->second.destroyed.insert(rank);
    if (possible(at->second.destroyed) == 0) semaphores_.erase(at);
    return {};
}

Result<void> GroupSync::semaphore_p(Rank rank, std::uint32_t name) {
    if (auto good = running(rank); !good) return good;
    const auto at = semaphores_.find(name);
    if (at == semaphores_.end() || at->second.destroyed.contains(rank)) return unknown("semaphore", name);
    hold(rank, Reason::semaphore, name);
    at->second.queue.push_back(rank);
    release_ready(at->second);
    return {};
}

Result<void> GroupSync::semaphore_v(Rank rank, std::uint32_t name) {
    if (auto good = running(rank); !good) return good;
    const auto at = semaphores_.find(name);
    if (at == semaphores_.end() || at->second.destroyed.contains(rank)) return unknown("semaphore", name);
    if (at->second.value >= kMaxValue) return fail("semaphore " + std::to_string(name) + " is too large");
    ++at->second.value;
    release_ready(at->second);
    return {};
}

void GroupSync::release_ready(Semaphore& semaphore) {
    for (; semaphore.value > 0 && !semaphore.queue.empty(); --semaphore.value) {
        release(semaphore.queue.front());
        semaphore.queue.pop_front();
    }
}

// ---- frames ----

void GroupSync::surface_open(Rank rank, SurfaceId surface) { surfaces_[surface].closed.erase(rank); }

bool GroupSync::surface_close(Rank rank, SurfaceId surface) {
    const auto at = surfaces_.find(surface);
    if (at == surfaces_.end()) return false;
    at->second.closed.insert(rank);
    release_ready(surface, at->second);
    const bool last = possible(at->second.closed) == 0;
    if (last) surfaces_.erase(at);
    return last;
}

Result<void> GroupSync::swap(Rank rank, SurfaceId surface, std::uint32_t frame) {
    if (auto good = running(rank); !good) return good;
    const auto at = surfaces_.find(surface);
    if (at == surfaces_.end() || at->second.closed.contains(rank))
        return fail(rank_text(rank) + " has no window " + std::to_string(surface.value));
    auto& last = at->second.swapped[rank];
    if (frame <= last)
        return fail(rank_text(rank) + " ends frame " + std::to_string(frame) + " after frame " + std::to_string(last));
    last = frame;
    hold(rank, Reason::swap, surface.value, frame);
    release_ready(surface, at->second);
    return {};
}

/// A member's later frame stands for those before: a node may come to the members at different ones.
void GroupSync::release_ready(SurfaceId surface, Frames& frames) {
    std::optional<std::uint32_t> least;
    for (Rank rank = 0; rank < size(); ++rank) {
        if (members_[rank].state == State::left || frames.closed.contains(rank)) continue;
        const auto at = frames.swapped.find(rank);
        least = std::min(least.value_or(UINT32_MAX), at == frames.swapped.end() ? 0 : at->second);
    }
    if (!least || *least <= frames.finished) return;
    frames.finished = *least;
    finished_.push_back({surface, *least});
    for (Rank rank = 0; rank < size(); ++rank) {
        const Member& member = members_[rank];
        if (waits(rank) && member.reason == Reason::swap && member.name == surface.value && member.frame <= *least)
            release(rank);
    }
}

}  // namespace wall::tileserver
