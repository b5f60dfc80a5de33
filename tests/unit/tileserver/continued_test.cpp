// SPDX-License-Identifier: MIT
#include "tileserver/render/continued.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace wall::tileserver {
namespace {

using Clock = std::chrono::steady_clock;

/// When this process was told to go on, in the clock's own units; 0: not yet. Another process says so, which goes on
/// while this one is stopped.
using ToldAt = std::atomic<Clock::rep>;

/// Stops this process for a tenth of a second.
void be_stopped(ToldAt& told_at) {
    const pid_t us = ::getpid(), other = ::fork();
    if (other == 0) {
        ::kill(us, SIGSTOP);
        ::usleep(100'000);
        told_at = Clock::now().time_since_epoch().count();
        ::kill(us, SIGCONT);
        ::_exit(0);
    }
    int status = 0;
    while (::waitpid(other, &status, 0) < 0) continue;
}

TEST(Continued, IsKnownToWhoMeasuresBeforeItReadsTheTime) {
    void* shared = ::mmap(nullptr, sizeof(ToldAt), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(shared, MAP_FAILED);
    ToldAt& told_at = *new (shared) ToldAt(0);
    std::atomic<bool> measuring = false;
    continued::expect();
    // Made by who does not hear, so that it does not take the signal itself.
    std::thread stops([&] {
        measuring.wait(false);
        be_stopped(told_at);
    });
    std::thread measures([&] {
        continued::hear();
        const auto before = continued::count();
        const auto begin = Clock::now();
        measuring = true;
        measuring.notify_one();
        while (told_at == 0) {  // whatever it does meanwhile
            if (Clock::now() - begin < std::chrono::seconds(10)) continue;
            ADD_FAILURE() << "it was never stopped";
            return;
        }
        EXPECT_EQ(continued::count(), before + 1);
    });
    measures.join();
    stops.join();
    ::munmap(shared, sizeof(ToldAt));
}

}  // namespace
}  // namespace wall::tileserver
