// SPDX-License-Identifier: MIT
#include "common/log/last_words.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <stdexcept>
#include <thread>

namespace wall::log {
namespace {

class LastWordsTest : public ::testing::Test {
protected:
    void SetUp() override {
#if defined(__has_feature)
        if (__has_feature(address_sanitizer)) GTEST_SKIP() << "AddressSanitizer says it";
#endif
        ::testing::GTEST_FLAG(death_test_style) = "threadsafe";
    }
};

TEST_F(LastWordsTest, SayTheSignalAndTheAddressAndLetItKill) {
    EXPECT_EXIT(
        {
            leave_last_words("daemon");
            *reinterpret_cast<volatile int*>(0x10) = 1;
        },
        ::testing::KilledBySignal(SIGSEGV),
        "daemon error crashed signal=11 thread=[0-9]+ address=0x10\n.*foreign_text");
}

TEST_F(LastWordsTest, AreThereForASignalThatWasSent) {
    EXPECT_EXIT(
        {
            leave_last_words("daemon");
            ::kill(::getpid(), SIGBUS);
            ::pause();
        },
        ::testing::KilledBySignal(SIGBUS), "daemon error crashed signal=7 ");
}

TEST_F(LastWordsTest, AreThereForAnExceptionThatNobodyCatches) {
    EXPECT_EXIT(
        {
            leave_last_words(std::string(1000, 'x'));
            std::thread([] { throw std::runtime_error("nobody catches it"); }).join();
        },
        ::testing::KilledBySignal(SIGABRT), "nobody catches it\n?.*x error crashed signal=6");
}

}  // namespace
}  // namespace wall::log
