// SPDX-License-Identifier: MIT
#include "tools/wallctl/interrupts.h"

#include <atomic>
#include <csignal>

namespace wall::wallctl {
namespace {

std::atomic<std::size_t> have_come = 0;

}  // namespace

void watch_for_interrupts() {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { ++have_come; });
}

std::size_t interruptions() { return have_come; }

}  // namespace wall::wallctl
