// SPDX-License-Identifier: MIT
#include "common/codec/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>

namespace wall::codec {
namespace {

TEST(WorkerPool, RunsEveryIndexOnce) {
    WorkerPool pool(3);
    for (std::size_t count = 0; count < 50; ++count) {
        std::vector<std::atomic<int>> runs(count);
        pool.run(count, [&](std::size_t i) { ++runs[i]; });
        for (const auto& times : runs) EXPECT_EQ(times, 1);
    }
}

TEST(WorkerPool, ServesSeveralCallers) {
    WorkerPool pool(2);
    std::atomic<int> total{0};
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 4; ++caller)
        callers.emplace_back([&] {
            for (int time = 0; time < 100; ++time) pool.run(7, [&](std::size_t) { ++total; });
        });
    for (auto& caller : callers) caller.join();
    EXPECT_EQ(total, 4 * 100 * 7);
}

TEST(WorkerPool, WithoutThreadsTheCallerDoesAll) {
    WorkerPool pool(0);
    int total = 0;
    pool.run(5, [&](std::size_t i) { total += static_cast<int>(i); });
    EXPECT_EQ(total, 10);
}

}  // namespace
}  // namespace wall::codec
