// SPDX-License-Identifier: MIT
// The order between the streams of a parallel program on one node: barriers, semaphores and the collective swap (Igehy,
// Stoll, Hanrahan, "The Design of a Parallel Graphics Interface", 1998; T, section 6.3). A command that must wait is
// carried out by holding its member's stream. Pure: no time, no OpenGL; one thread.
//
//             join (until all have)
//   absent ------------------------> running <----------------------------------------+
//                                       |   barrier_exec, semaphore_p, swap            | enough others came
//                                       +-----------------------------------> waiting -+
//                                       | leave
//                                       +-----------------------------------> left
//
// Nothing waits for a member that has left or has destroyed the object: the counts are never more than the members that
// can still come. What is left that can never go on (all members wait) is a deadlock, and said.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"

namespace wall::tileserver {

using Rank = std::uint32_t;  ///< of a member in its group, from 0

/// All members have ended a frame of a shared surface.
struct FinishedFrame {
    SurfaceId surface;
    std::uint32_t frame = 0;
    bool operator==(const FinishedFrame&) const = default;
};

class GroupSync {
public:
    static constexpr std::size_t kMaxObjects = 4096;  ///< barriers, semaphores: each

    /// `gone`: members that have left before this node came to the group.
    explicit GroupSync(std::uint32_t size, const std::set<Rank>& gone = {});

    std::uint32_t size() const { return static_cast<std::uint32_t>(members_.size()); }
    /// The member's next command may not be executed yet.
    bool waits(Rank rank) const { return members_[rank].state == State::waiting; }
    bool left(Rank rank) const { return members_[rank].state == State::left; }
    /// Why no member can ever go on; nothing as long as one can.
    std::optional<std::string> deadlock() const;
    /// Frames that were finished since the last call.
    std::vector<FinishedFrame> take_finished();

    // What a member's stream says, in its order. An error ends the group: the program is wrong.
    Result<void> join(Rank rank);
    Result<void> leave(Rank rank);
    Result<void> barrier_create(Rank rank, std::uint32_t name, std::uint32_t count);
    Result<void> barrier_destroy(Rank rank, std::uint32_t name);
    Result<void> barrier_exec(Rank rank, std::uint32_t name);
    /// `moved`: what this member has added and taken before this node came to the group.
    Result<void> semaphore_create(Rank rank, std::uint32_t name, std::uint32_t count, std::int32_t moved);
    Result<void> semaphore_destroy(Rank rank, std::uint32_t name);
    Result<void> semaphore_p(Rank rank, std::uint32_t name);
    Result<void> semaphore_v(Rank rank, std::uint32_t name);
    /// The member draws on the surface (again): its frames wait for this member.
    void surface_open(Rank rank, SurfaceId surface);
    /// True: it was the last one.
    bool surface_close(Rank rank, SurfaceId surface);
    Result<void> swap(Rank rank, SurfaceId surface, std::uint32_t frame);

private:
    enum class State { absent, running, waiting, left };
    enum class Reason { join, barrier, semaphore, swap };
    struct Member {
        State state = State::absent;
        bool joined = false;
        Reason reason{};
        std::uint32_t name = 0, frame = 0;  ///< what it waits for
    };
    struct Barrier {
        std::uint32_t count = 0;
        std::set<Rank> inside, destroyed;
    };
    struct Semaphore {
        std::uint32_t count = 0;
        std::int64_t value = 0;
        std::deque<Rank> queue;
        std::set<Rank> destroyed;
    };
    struct Frames {
        std::map<Rank, std::uint32_t> swapped;  ///< last frame
        std::set<Rank> closed;
        std::uint32_t finished = 0;
    };

    Result<void> running(Rank rank) const;
    void hold(Rank rank, Reason reason, std::uint32_t name, std::uint32_t frame = 0);
    void release(Rank rank) { members_[rank].state = State::running; }
    /// Members that have neither left nor are in `without`.
    std::uint32_t possible(const std::set<Rank>& without) const;
    void release_joined();
    void release_ready(Barrier& barrier);
    void release_ready(Semaphore& semaphore);
    void release_ready(SurfaceId surface, Frames& frames);
    std::string waiting_text(Rank rank) const;

    std::vector<Member> members_;
    std::map<std::uint32_t, Barrier> barriers_;
    std::map<std::uint32_t, Semaphore> semaphores_;
    std::map<SurfaceId, Frames> surfaces_;
    std::vector<FinishedFrame> finished_;
};

}  // namespace wall::tileserver
