// SPDX-License-Identifier: MIT
// Group [sync]: the order between the members of a parallel program. A command only notes what the member has come to;
// the render thread holds the stream before its next batch. Render thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class SyncCommands {
public:
    /// `execution` outlives it.
    explicit SyncCommands(Execution& execution) : execution_(execution) {}

    void Join();
    void Leave();
    void BarrierCreate(std::uint32_t barrier, std::uint32_t count);
    void BarrierDestroy(std::uint32_t barrier);
    void BarrierExec(std::uint32_t barrier);
    void SemaphoreCreate(std::uint32_t semaphore, std::uint32_t count, std::int32_t moved);
    void SemaphoreDestroy(std::uint32_t semaphore);
    void SemaphoreP(std::uint32_t semaphore);
    void SemaphoreV(std::uint32_t semaphore);

private:
    Execution& execution_;
};

/// Whether a command that may hold the stream is not the last one of its batch: what stands behind it would be executed
/// too early. `opcodes`: last first.
bool holds_early(const SessionReplica& session, std::span<const std::byte> opcodes);

}  // namespace wall::tileserver
