// SPDX-License-Identifier: MIT
// Processes in which the driver's shader compiler may take what it likes. A compiler has no bounds of its own: two
// functions of a few lines can make it write gigabytes for minutes (calls within calls, each put in line), or crash it.
// So a node tries each shader and program in such a process first, whose processor time and memory are bounded, and
// gives its own driver only what came through there.
//
// The processes are forked from one that is forked early, before this one has threads and a driver: no program is
// executed, so a node needs no more rights than it has. They end with it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/base/unique_fd.h"
#include "tileserver/gpu/backend.h"

namespace wall::tileserver {

/// What one shader or program may take.
struct CompilerLimits {
    std::chrono::seconds processor_time{10};
    std::chrono::seconds time{120};                 ///< on a machine that has other things to do, too
    std::uint64_t memory = std::uint64_t{2} << 30;  ///< bytes, with the driver's own; 0: no limit
};

class CompilerHost {
public:
    /// Forks. While this process has one thread.
    static Result<std::unique_ptr<CompilerHost>> start(BackendChoice backend, const CompilerLimits& limits = {});
    /// All compilers end.
    ~CompilerHost();
    CompilerHost(const CompilerHost&) = delete;

    const CompilerLimits& limits() const { return limits_; }
    /// The socket of a new compiler (compiler_messages.h), which ends when that is closed. Any thread.
    Result<UniqueFd> open() const;

private:
    CompilerHost(UniqueFd socket, pid_t process, const CompilerLimits& limits)
        : socket_(std::move(socket)), process_(process), limits_(limits) {}

    UniqueFd socket_;  // takes sockets for new compilers
    pid_t process_;
    CompilerLimits limits_;
};

}  // namespace wall::tileserver
