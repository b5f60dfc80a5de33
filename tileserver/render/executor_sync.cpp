// SPDX-License-Identifier: MIT
// The order between the members of a parallel program. A handler only notes what the member has come to; the render
// thread holds the stream before its next batch. Render thread.
#include <algorithm>
#include <cstring>

#include "tileserver/render/executor.h"

namespace wall::tileserver {
namespace {

constexpr glapi::Op kHolding[] = {glapi::Op::Join, glapi::Op::Leave, glapi::Op::BarrierExec, glapi::Op::SemaphoreP,
                                  glapi::Op::Swap};

}  // namespace

/// `opcodes`: last first. What would stand behind a command that holds would be executed too early.
bool Executor::holds_early(std::span<const std::byte> opcodes) const {
    if (session_.group() == nullptr || opcodes.size() < 2) return false;
    return std::ranges::any_of(kHolding, [&](glapi::Op op) {
        return std::memchr(opcodes.data() + 1, static_cast<int>(op), opcodes.size() - 1) != nullptr;
    });
}

void Executor::Join() {
    say_to_group([](GroupSync& sync, Rank rank) { return sync.join(rank); });
}
void Executor::Leave() {
    say_to_group([](GroupSync& sync, Rank rank) { return sync.leave(rank); });
}
void Executor::BarrierCreate(std::uint32_t barrier, std::uint32_t count) {
    say_to_group([=](GroupSync& sync, Rank rank) { return sync.barrier_create(rank, barrier, count); });
}
void Executor::BarrierDestroy(std::uint32_t barrier) {
    say_to_group([=](GroupSync& sync, Rank rank) { return sync.barrier_destroy(rank, barrier); });
}
void Executor::BarrierExec(std::uint32_t barrier) {
    say_to_group([=](GroupSync& sync, Rank rank) { return sync.barrier_exec(rank, barrier); });
}
void Executor::SemaphoreCreate(std::uint32_t semaphore, std::uint32_t count, std::int32_t moved) {
    say_to_group([=](GroupSync& sync, Rank rank) { return sync.semaphore_create(rank, semaphore, count, moved); });
}
void Executor::SemaphoreDestroy(std::uint32_t semaphore) {
    say_to_group([=](GroupSync& sync, Rank rank) { return sync.semaphore_destroy(rank, semaphore); });
}
void Executor::SemaphoreP(std::uint32_t semaphore) {
    say_to_group([=](GroupSync& sync, Rank rank) { return sync.semaphore_p(rank, semaphore); });
}
void Executor::SemaphoreV(std::uint32_t semaphore) {
    say_to_group([=](GroupSync& sync, Rank rank) { return sync.semaphore_v(rank, semaphore); });
}

}  // namespace wall::tileserver
