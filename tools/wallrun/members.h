// SPDX-License-Identifier: MIT
// The processes of a parallel program (docs/parallel-programs.md): each gets WALLGL_PARALLEL=GROUP:RANK:MEMBERS. One
// thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace wall::wallrun {

struct MemberRank {
    std::uint32_t rank = 0, members = 0;
    bool operator==(const MemberRank&) const = default;
};

using Environment = std::function<std::string(const char* name)>;  ///< a variable's value; empty without it

/// What an MPI launcher (Open MPI, or one that speaks PMI: MPICH, Intel, Slurm) says of this process.
Result<MemberRank> rank_from_launcher(const Environment& environment);
/// The value of WALLGL_PARALLEL; an error says what is wrong with the name or the number of processes.
Result<std::string> parallel_value(const std::string& group, const MemberRank& member);
/// A name that no other parallel program has.
std::string new_group_name(const std::string& program);

/// Starts `members` processes of a command and waits for all. When one fails (a signal, or an exit code that is not 0)
/// the others get SIGTERM soon, as an MPI launcher does it, and SIGKILL after a while. SIGINT, SIGTERM and SIGHUP go to
/// all of them. Gives the first failure's exit code (128 + the signal), or 0.
int run_members(const std::string& group, std::uint32_t members, std::vector<std::string> command);

}  // namespace wall::wallrun
