// SPDX-License-Identifier: MIT
// Shells stand for the processes of GPUs.
#include "tileserver/gpu_processes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include "common/base/unique_fd.h"
#include "tests/support/temporary_folder.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

// What systemd-notify would do, without a package for it; as whoever $as makes of us.
constexpr const char* kNotify =
    "say() { $as /usr/bin/python3 -c 'import os, socket, sys\n"
    "s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)\n"
    "s.sendto(sys.argv[1].encode(), chr(0) + os.environ[\"NOTIFY_SOCKET\"][1:])' \"$1\"; }\n";

constexpr GpuProcesses::Limits kQuick{50ms, 100ms, 20s, 20s, 3s};

constexpr int kTries = 2000;  // 10 ms each

class ProcessesOfGpus : public ::testing::Test {
protected:
    using Ended = GpuProcesses::Ended;
    /// Each GPU runs the script, with its name as $1, in the folder.
    Result<Ended> run(const std::vector<std::string>& gpus, const std::string& script,
                      const GpuProcesses::Limits& limits = kQuick) {
        const auto command = [&](const std::string& gpu) {
            return std::vector<std::string>{"/bin/sh", "-c", "cd " + folder_.file("") + "\n" + kNotify + script, "sh",
                                            gpu};
        };
        return GpuProcesses(
                   gpus, command, [this] { std::ofstream(folder_.file("ready")) << "yes"; }, limits)
            .run();
    }
    std::string content(const std::string& name) const {
        std::ostringstream text;
        text << std::ifstream(folder_.file(name)).rdbuf();
        return text.str();
    }
    test::TemporaryFolder folder_;
};

TEST_F(ProcessesOfGpus, AreReadyWhenAllAre) {
    const auto ended = run({"a", "b"},
                           "[ $1 = a ] || sleep 0.3; [ -e ready ] && exit 1; say READY=1\n"
                           "while ! [ -e ready ]; do sleep 0.02; done; exit 100");
    ASSERT_TRUE(ended) << ended.error().message;
    EXPECT_EQ(*ended, Ended::starts_anew);
    EXPECT_EQ(content("ready"), "yes");
}

/// What systemd would hear.
TEST_F(ProcessesOfGpus, SayThatTheyStopOnlyIfTheyDo) {
    for (const auto& [code, told] : {std::pair("100", ""), std::pair("2", "STOPPING=1")}) {
        const UniqueFd socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
        const auto path = folder_.file(std::string("systemd") + code);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        ASSERT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
        const auto ended = run({"a"}, std::string("exit ") + code);
        ::unsetenv("NOTIFY_SOCKET");
        ASSERT_TRUE(ended) << ended.error().message;
        std::array<char, 64> text{};
        const auto bytes = ::recv(socket.get(), text.data(), text.size(), MSG_DONTWAIT);
        EXPECT_EQ(std::string(text.data(), bytes > 0 ? static_cast<std::size_t>(bytes) : 0), told);
    }
}

TEST_F(ProcessesOfGpus, HearNobodyElse) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can be somebody else";
    const std::string nobody = "as='/usr/bin/setpriv --reuid 65534 --regid 65534 --clear-groups'\n";
    for (const auto& [who, heard] : {std::pair(nobody, ""), std::pair(std::string("as=\n"), "yes")}) {
        const auto ended = run({"a"}, who + "say READY=1 && touch said; sleep 0.3; exit 100");
        ASSERT_TRUE(ended) << ended.error().message;
        EXPECT_TRUE(std::filesystem::remove(folder_.file("said"))) << "it was sent";
        EXPECT_EQ(content("ready"), heard) << who;
    }
}

TEST_F(ProcessesOfGpus, AreStartedAgainWithoutTheOthers) {
    const auto ended = run({"a", "b"},
                           "echo $$ >>$1; say READY=1\n"
                           "if [ $1 = a ]; then [ $(wc -l <a) -ge 3 ] && exit 100; kill -9 $$; fi; exec sleep 60");
    ASSERT_TRUE(ended) << ended.error().message;
    EXPECT_EQ(*ended, Ended::starts_anew);
    EXPECT_EQ(std::ranges::count(content("a"), '\n'), 3) << content("a");
    EXPECT_EQ(std::ranges::count(content("b"), '\n'), 1);
    EXPECT_NE(::kill(std::stoi(content("b")), 0), 0) << "is gone";
}

TEST_F(ProcessesOfGpus, AreKilledWhenTheySayNothing) {
    auto limits = kQuick;
    limits.silence = 1s;
    const auto ended = run({"a"},
                           "echo x >>a; say READY=1\n"
                           "if [ $(wc -l <a) = 2 ]; then for i in 1 2 3 4 5 6 7 8; do sleep 0.3; say WATCHDOG=1; "
                           "done; exit 100; fi; exec sleep 60",
                           limits);
    ASSERT_TRUE(ended) << ended.error().message;
    EXPECT_EQ(*ended, Ended::starts_anew) << "the second one lived, by its signs";
    EXPECT_EQ(content("a"), "x\nx\n");
}

TEST_F(ProcessesOfGpus, OfAMistakeAreNotStartedAgain) {
    const auto ended = run({"a", "b"}, "echo x >>$1; [ $1 = a ] && exit 2; exec sleep 60");
    ASSERT_TRUE(ended) << ended.error().message;
    EXPECT_EQ(*ended, Ended::mistaken);
    EXPECT_EQ(content("a"), "x\n");
}

TEST_F(ProcessesOfGpus, WaitForAProgramThatIsBeingReplaced) {
    int tries = 0;
    const auto command = [&](const std::string&) {
        if (++tries < 3) return std::vector<std::string>{"/nowhere/tileserver"};
        return std::vector<std::string>{"/bin/sh", "-c", "exit 100"};
    };
    EXPECT_EQ(*GpuProcesses({"a"}, command, {}, kQuick).run(), Ended::starts_anew);
    EXPECT_EQ(tries, 3);
}

TEST_F(ProcessesOfGpus, EndWithTheirParentInOrder) {
    const auto parent = ::getpid();
    std::thread asks([parent, this] {
        for (int i = 0; i < kTries && content("ready").empty(); ++i) std::this_thread::sleep_for(10ms);
        ::kill(parent, SIGTERM);
    });
    const auto ended = run({"a", "b"},
                           "gpu=$1; trap 'echo in order >end-$gpu; exit 0' TERM; [ $1 = b ] && trap '' TERM\n"
                           "echo $$ >$1; say READY=1; while :; do sleep 0.02; done");
    asks.join();
    ASSERT_TRUE(ended) << ended.error().message;
    EXPECT_EQ(*ended, Ended::stopped);
    EXPECT_EQ(content("end-a"), "in order\n");
    EXPECT_NE(::kill(std::stoi(content("b")), 0), 0) << "who does not hear is killed";
}

TEST_F(ProcessesOfGpus, EndWithAParentThatIsKilled) {
    const pid_t parent = ::fork();
    if (parent == 0) {
        static_cast<void>(run({"a"}, "echo $$ >a; say READY=1; while :; do sleep 0.02; done"));
        ::_exit(0);
    }
    for (int i = 0; i < kTries && content("ready").empty(); ++i) std::this_thread::sleep_for(10ms);
    ::kill(parent, SIGKILL);
    ::waitpid(parent, nullptr, 0);
    const pid_t child = std::stoi(content("a"));
    for (int i = 0; i < kTries && ::kill(child, 0) == 0; ++i) std::this_thread::sleep_for(10ms);
    EXPECT_NE(::kill(child, 0), 0);
}

}  // namespace
}  // namespace wall::tileserver
