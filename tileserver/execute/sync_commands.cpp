// SPDX-License-Identifier: MIT
#include "tileserver/execute/sync_commands.h"

#include <algorithm>
#include <cstring>

#include "tileserver/execute/say_to_group.h"

namespace wall::tileserver {
namespace {

constexpr glapi::Op kHolding[] = {glapi::Op::Join, glapi::Op::Leave, glapi::Op::BarrierExec, glapi::Op::SemaphoreP,
                                  glapi::Op::Swap};

}  // namespace

bool holds_early(const SessionReplica& session, std::span<const std::byte> opcodes) {
    if (session.group() == nullptr || opcodes.size() < 2) return false;
    return std::ranges::any_of(kHolding, [&](glapi::Op op) {
        return std::memchr(opcodes.data() + 1, static_cast<int>(op), opcodes.size() - 1) != nullptr;
    });
}

void SyncCommands::Join() {
    say_to_group(execution_, [](GroupSync& sync, Rank rank) { return sync.join(rank); });
}
void SyncCommands::Leave() {
    say_to_group(execution_, [](GroupSync& sync, Rank rank) { return sync.leave(rank); });
}
void SyncCommands::BarrierCreate(std::uint32_t barrier, std::uint32_t count) {
    say_to_group(execution_, [=](GroupSync& sync, Rank rank) { return sync.barrier_create(rank, barrier, count); });
}
void SyncCommands::BarrierDestroy(std::uint32_t barrier) {
    say_to_group(execution_, [=](GroupSync& sync, Rank rank) { return sync.barrier_destroy(rank, barrier); });
}
void SyncCommands::BarrierExec(std::uint32_t barrier) {
    say_to_group(execution_, [=](GroupSync& sync, Rank rank) { return sync.barrier_exec(rank, barrier); });
}
void SyncCommands::SemaphoreCreate(std::uint32_t semaphore, std::uint32_t count, std::int32_t moved) {
    say_to_group(execution_,
                 [=](GroupSync& sync, Rank rank) { return sync.semaphore_create(rank, semaphore, count, moved); });
}
void SyncCommands::SemaphoreDestroy(std::uint32_t semaphore) {
    say_to_group(execution_, [=](GroupSync& sync, Rank rank) { return sync.semaphore_destroy(rank, semaphore); });
}
void SyncCommands::SemaphoreP(std::uint32_t semaphore) {
    say_to_group(execution_, [=](GroupSync& sync, Rank rank) { return sync.semaphore_p(rank, semaphore); });
}
void SyncCommands::SemaphoreV(std::uint32_t semaphore) {
    say_to_group(execution_, [=](GroupSync& sync, Rank rank) { return sync.semaphore_v(rank, semaphore); });
}

}  // namespace wall::tileserver
