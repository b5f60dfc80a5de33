// SPDX-License-Identifier: MIT
#include "tools/wallrun/members.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <random>
#include <utility>

#include "common/wire/limits.h"

namespace wall::wallrun {
namespace {

constexpr timespec kNotice{.tv_sec = 0,
                           .tv_nsec = 300'000'000};       // for the others to hear from walld why, and to say so
constexpr timespec kEndLimit{.tv_sec = 5, .tv_nsec = 0};  // for SIGTERM to be obeyed
constexpr int kNotFound = 127, kNotStarted = 126;         // as a shell says it

struct Variables {
    const char *rank, *members;
};
constexpr Variables kLaunchers[] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}};

bool read_number(const std::string& text, std::uint32_t& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

sigset_t handled_signals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, signal);
    return set;
}

[[noreturn]] void become_member(const std::string& value, std::vector<std::string>& command, pid_t parent) {
    const sigset_t handled = handled_signals();
    sigprocmask(SIG_UNBLOCK, &handled, nullptr);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(kNotStarted);  // it died before the line above
    ::setenv("WALLGL_PARALLEL", value.c_str(), 1);
    std::vector<char*> arguments;
    for (auto& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    const int error = errno;
    std::cerr << "wallrun: " + command[0] + ": " + std::strerror(error) + "\n" << std::flush;
    ::_exit(error == ENOENT ? kNotFound : kNotStarted);
}

/// The members that run, and how the first failure ended.
class Members {
public:
    void add(pid_t pid) { running_.push_back(pid); }
    bool any() const { return !running_.empty(); }
    bool failing() const { return code_ != 0; }
    const timespec& patience() const { return asked_ ? kEndLimit : kNotice; }
    int code() const { return code_; }
    /// By somebody else: what ends now does not end by itself.
    void pass_on(int number) {
        told_ = true;
        signal_all(number);
    }
    void signal_all(int number) const {
        for (const pid_t pid : running_) ::kill(pid, number);
    }
    void fail(int code) {
        if (!failing()) code_ = code;
    }
    /// First politely.
    void end() { signal_all(std::exchange(asked_, true) ? SIGKILL : SIGTERM); }
    void reap() {
        int status = 0;
        for (pid_t pid = ::waitpid(-1, &status, WNOHANG); pid > 0; pid = ::waitpid(-1, &status, WNOHANG)) {
            std::erase(running_, pid);
            const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
            if (code == 0) continue;
            if (!failing() && !told_ && any())
                std::cerr << "wallrun: process " << pid << " of the parallel program ended with " << code
                          << ": the others are ended, too\n";
            fail(code);
        }
    }

private:
    std::vector<pid_t> running_;
    int code_ = 0;
    bool asked_ = false, told_ = false;
};

}  // namespace

Result<MemberRank> rank_from_launcher(const Environment& environment) {
    for (const auto& names : kLaunchers) {
        MemberRank found;
        if (environment(names.rank).empty()) continue;
        if (read_number(environment(names.rank), found.rank) && read_number(environment(names.members), found.members))
            return found;
    }
    return fail(
        "no MPI launcher has said which rank this process has: expected OMPI_COMM_WORLD_RANK and OMPI_COMM_WORLD_SIZE, "
        "or PMI_RANK and PMI_SIZE "
        "(mpirun -n N wallrun --parallel-group NAME -- PROGRAM; without MPI: wallrun --parallel N -- PROGRAM)");
}

Result<std::string> parallel_value(const std::string& group, const MemberRank& member) {
    if (group.empty() || member.members == 0 || member.members > wire::kMaxMembers || member.rank >= member.members)
        return fail("a parallel program needs a name and 1 to " + std::to_string(wire::kMaxMembers) +
                    " processes with ranks from 0: got '" + group + "', rank " + std::to_string(member.rank) + " of " +
                    std::to_string(member.members));
    return group + ":" + std::to_string(member.rank) + ":" + std::to_string(member.members);
}

std::string new_group_name(const std::string& program) {
    std::random_device random;
    constexpr char kDigits[] = "0123456789abcdef";
    std::string name = std::filesystem::path(program).filename().string() + "-";
    for (int i = 0; i < 16; ++i) name += kDigits[random() % 16];
    return name;
}

int run_members(const std::string& group, std::uint32_t members, std::vector<std::string> command) {
    const sigset_t handled = handled_signals();
    sigprocmask(SIG_BLOCK, &handled, nullptr);  // before the first member, so that no end of one is missed
    const pid_t parent = ::getpid();
    Members all;
    for (std::uint32_t rank = 0; rank < members && !all.failing(); ++rank) {
        const pid_t pid = ::fork();
        if (pid == 0) become_member(*parallel_value(group, {rank, members}), command, parent);
        if (pid > 0) all.add(pid);
        else all.fail(kNotStarted);
    }
    while (all.any()) {
        const int signal =
            all.failing() ? ::sigtimedwait(&handled, nullptr, &all.patience()) : ::sigwaitinfo(&handled, nullptr);
        if (signal == SIGCHLD) all.reap();
        else if (signal > 0) all.pass_on(signal);
        else if (errno == EAGAIN) all.end();
    }
    return all.code();
}

}  // namespace wall::wallrun
