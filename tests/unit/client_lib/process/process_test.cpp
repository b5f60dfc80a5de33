// SPDX-License-Identifier: MIT
// The end of the process, and processes with more rights than those who start them.
#include "client_lib/process/process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <vector>

#include "client_lib/link/control.h"

namespace wall::client {
namespace {

namespace fs = std::filesystem;

constexpr int kGood = 7;  // exit code
constexpr int kLimitMs = 300;

std::mutex held;

TEST(ProcessEndDeathTest, ActionsRunLastFirst) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    static std::atomic<int> order{0};
    EXPECT_EXIT(
        {
            at_process_end([] { ::_exit(order == 1 ? kGood : 1); }, kLimitMs);
            at_process_end([] { ++order; }, kLimitMs);
            ::exit(0);
        },
        testing::ExitedWithCode(kGood), "");
}

TEST(ProcessEndDeathTest, ExitInASignalHandlerEndsAlthoughTheInterruptedThreadHoldsWhatTheEndNeeds) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            ::alarm(20);  // in case that it does not
            ::signal(SIGUSR1, [](int) { ::exit(kGood); });
            at_process_end([] { std::lock_guard lock(held); }, kLimitMs);
            std::lock_guard lock(held);
            ::raise(SIGUSR1);
        },
        testing::ExitedWithCode(kGood), "");
}

// ---- set-group-id ----

/// A group of ours that is not the process's own; -1: there is none.
gid_t other_group() {
    if (::geteuid() == 0) return 65534;
    std::vector<gid_t> groups(64);
    const int count = ::getgroups(static_cast<int>(groups.size()), groups.data());
    for (int i = 0; i < count; ++i)
        if (groups[static_cast<std::size_t>(i)] != ::getegid()) return groups[static_cast<std::size_t>(i)];
    return static_cast<gid_t>(-1);
}

/// A copy of this program that runs with the rights of a group.
class PrivilegedCopy {
public:
    explicit PrivilegedCopy(gid_t group) : folder_(fs::absolute("privileged." + std::to_string(::getpid()))) {
        fs::create_directory(folder_);
        fs::copy_file("/proc/self/exe", path());
        made_ = ::chown(path().c_str(), static_cast<uid_t>(-1), group) == 0 && ::chmod(path().c_str(), 02755) == 0;
    }
    ~PrivilegedCopy() { fs::remove_all(folder_); }
    PrivilegedCopy(const PrivilegedCopy&) = delete;
    bool made() const { return made_; }
    fs::path path() const { return folder_ / "copy"; }

    /// Runs one disabled test in it; its exit code.
    int run(const std::string& test) const {
        const pid_t child = ::fork();
        if (child == 0) {
            const std::string filter = "--gtest_filter=" + test;
            ::execl(path().c_str(), "copy", "--gtest_also_run_disabled_tests", filter.c_str(), nullptr);
            ::_exit(127);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    fs::path folder_;
    bool made_ = false;
};

// In the copy. 0: the environment means nothing; 3: it does; 4: no more rights than any other process.
TEST(Environment, DISABLED_Address) {
    ::_exit(::getegid() == ::getgid() ? 4 : walld_address() == "unix:/nowhere" ? 3 : 0);
}

TEST(Environment, MeansNothingToAProcessWithMoreRights) {
    const gid_t group = other_group();
    if (group == static_cast<gid_t>(-1)) GTEST_SKIP() << "this user is in one group only";
    const PrivilegedCopy copy(group);
    if (!copy.made()) GTEST_SKIP() << "no set-group-id here";
    ::setenv("WALLGL_WALLD", "unix:/nowhere", 1);
    EXPECT_EQ(walld_address(), "unix:/nowhere");
    const int code = copy.run("Environment.DISABLED_Address");
    ::unsetenv("WALLGL_WALLD");
    if (code == 4) GTEST_SKIP() << "the file system gives no rights (nosuid)";
    EXPECT_EQ(code, 0);
}

}  // namespace
}  // namespace wall::client
