// SPDX-License-Identifier: MIT
#include "common/codec/worker_pool.h"

#include <atomic>

namespace wall::codec {

/// Indexes are handed out until none is left. Threads that come late find none and never touch `body`, which is the
/// caller's.
struct WorkerPool::Job {
    Job(std::size_t wanted, const std::function<void(std::size_t)>& work) : count(wanted), body(work) {}

    const std::size_t count;
    const std::function<void(std::size_t)>& body;
    std::atomic<std::size_t> next{0}, done{0};

    void work() {
        for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) {
            body(i);
            if (done.fetch_add(1) + 1 == count) done.notify_all();
        }
    }
    void wait() {
        for (std::size_t now = done.load(); now < count; now = done.load()) done.wait(now);
    }
};

WorkerPool::WorkerPool(unsigned threads) {
    for (unsigned i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    for (auto& thread : threads_) thread.join();
}

void WorkerPool::run(std::size_t count, const std::function<void(std::size_t)>& body) {
    const auto job = std::make_shared<Job>(count, body);
    {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < threads_.size(); ++i) jobs_.push_back(job);
    }
    wake_.notify_all();
    job->work();
    job->wait();
}

void WorkerPool::work() {
    for (;;) {
        std::shared_ptr<Job> job;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
            if (jobs_.empty()) return;
            job = std::move(jobs_.front());
            jobs_.pop_front();
        }
        job->work();
    }
}

}  // namespace wall::codec
