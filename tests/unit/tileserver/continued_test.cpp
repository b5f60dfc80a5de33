// SPDX-License-Identifier: MIT
#include "tileserver/render/continued.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

namespace wall::tileserver {
namespace {

/// Stops this process for a tenth of a second.
void be_stopped() {
    const pid_t us = ::getpid(), other = ::fork();
    if (other == 0) {
        ::kill(us, SIGSTOP);
        ::usleep(100'000);
        ::kill(us, SIGCONT);
        ::_exit(0);
    }
    int status = 0;
    while (::waitpid(other, &status, 0) < 0) continue;
}

TEST(Continued, IsKnownToWhoMeasuresBeforeItReadsTheTime) {
    continued::expect();
    std::thread measures([] {
        continued::hear();
        const auto before = continued::count();
        const auto begin = std::chrono::steady_clock::now();
        std::thread([] { be_stopped(); }).detach();
        auto last = begin;
        for (;;) {  // whatever it does meanwhile
            const auto now = std::chrono::steady_clock::now();
            if (now - last > std::chrono::milliseconds(80)) break;
            if (now - begin > std::chrono::seconds(10)) {
                ADD_FAILURE() << "it was never stopped";
                return;
            }
            last = now;
        }
        EXPECT_EQ(continued::count(), before + 1);
    });
    measures.join();
}

}  // namespace
}  // namespace wall::tileserver
