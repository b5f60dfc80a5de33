// SPDX-License-Identifier: MIT
// What programs and people may have ([quota] in wall.toml). Nodes hold a program to what they are told with its ticket;
// what a person has is known here alone.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "walld/wall/session_stats.h"
#include "walld/wall/wall.h"

namespace wall::walld {
namespace {

double mebibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

}  // namespace

proto::Quota Wall::quota_of_programs() const {
    proto::Quota out;
    const auto& quota = config_.quota;
    if (quota.program_memory) out.set_memory(*quota.program_memory);
    if (quota.program_objects) out.set_objects(*quota.program_objects);
    if (quota.program_bandwidth) out.set_bandwidth(*quota.program_bandwidth);
    if (quota.program_fps) out.set_fps(*quota.program_fps);
    return out;
}

/// A program that was here before, or a process of one that is, takes no place.
Outcome<void> Wall::check_quota(const proto::ClientHello& hello, const Person& who) const {
    const auto most = config_.quota.person_programs;
    if (!most || hello.has_resume() || group_of(hello)) return {};
    const auto theirs =
        std::ranges::count_if(sessions_, [&](const auto& entry) { return entry.second.owner.same_as(who); });
    if (static_cast<std::uint64_t>(theirs) < *most) return {};
    return refuse(RefusalKind::busy, fmt::format("{} has {} programs on this wall, as many as a person may have "
                                                 "('person_programs' in [quota] of wall.toml)",
                                                 who.text(), theirs));
}

void Wall::node_reports(NodeIndex node, const proto::NodeStats& stats, std::chrono::system_clock::time_point here,
                        Clock::time_point now) {
    nodes_[node].stats = stats;
    if (stats.time_us() != 0 && here != std::chrono::system_clock::time_point()) {
        const std::chrono::microseconds there(static_cast<std::int64_t>(stats.time_us()));
        nodes_[node].clock_ahead = std::chrono::round<std::chrono::milliseconds>(there - here.time_since_epoch());
    }
    if (config_.quota.person_memory) end_who_has_too_much(node);
    balance(node, now);
}

/// Of whoever's programs fill too much of the node the largest one goes.
void Wall::end_who_has_too_much(NodeIndex node) {
    struct Theirs {
        std::uint64_t all = 0, largest = 0;
        SessionId program;
    };
    std::map<std::pair<Person::Kind, std::string>, Theirs> people;
    for (const auto& [id, stats] : stats_by_session(nodes_[node].stats)) {
        const auto* session = find(id);
        if (!session || session->owner.kind == Person::Kind::unknown) continue;
        auto& theirs = people[{session->owner.kind, session->owner.name}];
        theirs.all += stats.memory_bytes();
        if (stats.memory_bytes() < theirs.largest) continue;
        theirs.largest = stats.memory_bytes();
        theirs.program = id;
    }
    for (const auto& [who, theirs] : people) {
        if (theirs.all <= *config_.quota.person_memory) continue;
        out_.end_session(
            theirs.program,
            fmt::format("the programs of {} have {:.0f} MiB of objects on node '{}', and a person may have "
                        "{:.0f} ('person_memory' in [quota] of wall.toml): the largest is ended",
                        find(theirs.program)->owner.text(), mebibytes(theirs.all), nodes_[node].config->name,
                        mebibytes(*config_.quota.person_memory)));
        close_session(theirs.program);
    }
}

}  // namespace wall::walld
