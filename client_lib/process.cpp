// SPDX-License-Identifier: MIT
#include "client_lib/process.h"

#include <errno.h>
#include <pthread.h>

#include <array>
#include <atomic>

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

std::string program_name() { return program_invocation_short_name ? program_invocation_short_name : "unknown"; }

}  // namespace wall::client
