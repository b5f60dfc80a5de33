// SPDX-License-Identifier: MIT
// Threads for codecs that work on slices (ParallelFor). The thread that calls works too, so that a pool of n threads
// runs n + 1 at a time. Calls from several threads share the threads; every call returns when its own work is done.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "common/codec/codec.h"

namespace wall::codec {

class WorkerPool {
public:
    explicit WorkerPool(unsigned threads);
    /// No call may be under way.
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// May be used as long as the pool lives.
    ParallelFor parallel_for() {
        return [this](std::size_t count, const std::function<void(std::size_t)>& body) { run(count, body); };
    }
    void run(std::size_t count, const std::function<void(std::size_t)>& body);

private:
    struct Job;
    void work();

    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<std::shared_ptr<Job>> jobs_;
    bool stop_ = false;
    std::vector<std::thread> threads_;
};

/// parallel(count, body), or here and in order if it is empty.
inline void for_each_index(const ParallelFor& parallel, std::size_t count,
                           const std::function<void(std::size_t)>& body) {
    if (parallel) return parallel(count, body);
    for (std::size_t i = 0; i < count; ++i) body(i);
}

}  // namespace wall::codec
