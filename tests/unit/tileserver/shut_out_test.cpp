// SPDX-License-Identifier: MIT
#include "tileserver/io/shut_out.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

TEST(ShutOutTest, LongerEachTime) {
    ShutOut shut_out;
    const ShutOut::Clock::time_point start{};
    const SessionId session(3);
    EXPECT_FALSE(shut_out.wait(session, start));
    shut_out.blame(session, start);
    EXPECT_EQ(shut_out.wait(session, start), 10s);
    EXPECT_FALSE(shut_out.wait(SessionId(4), start));
    EXPECT_FALSE(shut_out.wait(session, start + 10s));
    shut_out.blame(session, start + 10s);
    EXPECT_EQ(shut_out.wait(session, start + 11s), 19s);
    shut_out.forget(session);
    EXPECT_FALSE(shut_out.wait(session, start + 11s));
}

}  // namespace
}  // namespace wall::tileserver
