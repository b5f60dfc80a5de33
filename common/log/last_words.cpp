// SPDX-License-Identifier: MIT
#include "common/log/last_words.h"

#include <execinfo.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace wall::log {
namespace {

constexpr int kMostCalls = 64;
std::array<char, 64> program_name{};  // a signal handler allocates nothing

void say(int signal, const siginfo_t& info) {
    std::array<char, 256> line;
    const bool has_address = signal != SIGABRT && info.si_code > 0;  // it comes from the processor
    const auto end = fmt::format_to_n(line.data(), line.size(), "{} error crashed signal={} thread={} address={:#x}\n",
                                      program_name.data(), signal, ::syscall(SYS_gettid),
                                      has_address ? reinterpret_cast<std::uintptr_t>(info.si_addr) : 0);
    (void)!::write(STDERR_FILENO, line.data(), std::min(end.size, line.size()));
}

void crash(int signal, siginfo_t* info, void*) {
    say(signal, *info);
    std::array<void*, kMostCalls> calls;
    ::backtrace_symbols_fd(calls.data(), ::backtrace(calls.data(), kMostCalls), STDERR_FILENO);
    // SA_RESETHAND has brought the default back. What the processor says comes again by itself, what was sent does not.
    ::raise(signal);
}

#if defined(__has_feature)
constexpr bool kHasSanitizer = __has_feature(address_sanitizer);
#elif defined(__SANITIZE_ADDRESS__)
constexpr bool kHasSanitizer = true;
#else
constexpr bool kHasSanitizer = false;
#endif

}  // namespace

void leave_last_words(const std::string& program) {
    if (kHasSanitizer) return;
    program.copy(program_name.data(), program_name.size() - 1);
    void* first = nullptr;
    ::backtrace(&first, 1);  // the first call loads a library, which is too late in a handler
    struct sigaction action {};
    action.sa_sigaction = crash;
    action.sa_flags = SA_SIGINFO | static_cast<int>(SA_RESETHAND);
    for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

}  // namespace wall::log
