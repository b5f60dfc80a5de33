// SPDX-License-Identifier: MIT
#include "client_lib/process.h"

#include <errno.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>

namespace wall::client {
namespace {

constexpr std::size_t kMaxActions = 16;  // each part of the library registers at most one

std::atomic<bool> forked{false};
std::atomic<bool> watching{false};
std::array<std::atomic<void (*)()>, kMaxActions> actions{};
std::atomic<std::size_t> action_count{0};

/// Runs at exit(): the library is linked with -z nodelete, so dlclose() does not bring it forward.
[[gnu::destructor]] void process_ends() {
    if (forked) return;
    for (auto i = std::min(action_count.load(), kMaxActions); i-- > 0;)
        if (auto* action = actions[i].load()) action();
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

void at_process_end(void (*action)()) {
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
            while (mine->count > 0) mine->actions[--mine->count]();
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
