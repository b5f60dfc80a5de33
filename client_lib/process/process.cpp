// SPDX-License-Identifier: MIT
#include "client_lib/process/process.h"

#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>

#include "client_lib/process/guard.h"

namespace wall::client {
namespace {

constexpr std::size_t kMaxActions = 16;  // each part of the library registers at most one

std::atomic<bool> forked{false};
std::atomic<bool> watching{false};
std::array<std::atomic<void (*)()>, kMaxActions> actions{};
std::atomic<std::size_t> action_count{0};
std::atomic<int> limit_ms_of_all{0};
sem_t actions_done;

void* run_actions(void*) {
    for (auto i = std::min(action_count.load(), kMaxActions); i-- > 0;)
        if (auto* action = actions[i].load()) action();
    sem_post(&actions_done);
    return nullptr;
}

void wait_for_actions(int limit_ms) {
    timespec until{};
    clock_gettime(CLOCK_REALTIME, &until);
    const long long nanoseconds = until.tv_nsec + limit_ms * 1'000'000LL;
    until.tv_sec += static_cast<time_t>(nanoseconds / 1'000'000'000);
    until.tv_nsec = static_cast<long>(nanoseconds % 1'000'000'000);
    while (sem_timedwait(&actions_done, &until) != 0 && errno == EINTR) continue;
}

/// Runs at exit(): the library is linked with -z nodelete, so dlclose() does not bring it forward.
[[gnu::destructor]] void process_ends() {
    if (forked || action_count == 0) return;
    sem_init(&actions_done, 0, 0);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
    const SignalsBlocked blocked;
    if (pthread_t thread; pthread_create(&thread, &attributes, run_actions, nullptr) == 0)
        wait_for_actions(limit_ms_of_all);
    else run_actions(nullptr);
    pthread_attr_destroy(&attributes);
}

}  // namespace

SignalsBlocked::SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
}

SignalsBlocked::~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

void watch_forks() {
    if (!watching.exchange(true)) pthread_atfork(nullptr, nullptr, [] { forked = true; });
}

bool in_forked_child() { return forked.load(std::memory_order_relaxed); }

void at_process_end(void (*action)(), int limit_ms) {
    limit_ms_of_all += limit_ms;
    const auto i = action_count.fetch_add(1);
    if (i < kMaxActions) actions[i] = action;
}

namespace {

/// A thread's actions, in a POSIX thread key: its destructor runs at the end of a thread only.
struct ThreadActions {
    std::array<void (*)(), kMaxActions> actions{};
    std::size_t count = 0;
};

pthread_key_t thread_key() {
    static const pthread_key_t key = [] {
        pthread_key_t made{};
        pthread_key_create(&made, [](void* data) {
            const std::unique_ptr<ThreadActions> mine(static_cast<ThreadActions*>(data));
            try {
                while (mine->count > 0) mine->actions[--mine->count]();
            } catch (...) {
                caught_exception("the end of a thread");
            }
        });
        return made;
    }();
    return key;
}

}  // namespace

void at_thread_end(void (*action)()) {
    auto* mine = static_cast<ThreadActions*>(pthread_getspecific(thread_key()));
    if (!mine) pthread_setspecific(thread_key(), mine = new ThreadActions);
    for (std::size_t i = 0; i < mine->count; ++i)
        if (mine->actions[i] == action) return;
    if (mine->count < kMaxActions) mine->actions[mine->count++] = action;
}

std::string program_name() { return program_invocation_short_name ? program_invocation_short_name : "unknown"; }

}  // namespace wall::client
