// SPDX-License-Identifier: MIT
#include "tools/wallctl/interrupts.h"

#include <atomic>
#include <csignal>

namespace wall::wallctl {
namespace {

std::atomic<bool> has_come = false;

}  // namespace

void watch_for_interrupts() {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { has_come = true; });
}

bool interrupted() { return has_come; }

}  // namespace wall::wallctl
