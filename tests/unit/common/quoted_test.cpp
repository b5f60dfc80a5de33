// SPDX-License-Identifier: MIT
#include "common/log/quoted.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/log/log.h"

namespace wall::log {
namespace {

static_assert(Harmless<int> && Harmless<Quoted> && Harmless<Plain>);
static_assert(!Harmless<std::string> && !Harmless<const char*> && !Harmless<std::string_view>,
              "a name that is given as it is must not compile");

TEST(Quoted, KeepsWhatIsHarmless) {
    EXPECT_EQ(log::quoted("glxgears -geometry 1x1").text, "\"glxgears -geometry 1x1\"");
}

TEST(Quoted, IsOneLineOfPrintableAsciiWhateverItWas) {
    std::string all;
    for (int c = 0; c < 256; ++c) all += static_cast<char>(c);
    const auto text = log::quoted(all).text;
    EXPECT_TRUE(std::ranges::all_of(text, [](unsigned char c) { return c >= 0x20 && c <= 0x7e; })) << text;
}

TEST(Quoted, EndsOnlyWhereItEnds) {
    EXPECT_EQ(log::quoted("a\" result=ok\nsession_end session=1\\").text,
              R"("a\" result=ok\nsession_end session=1\\")");
    EXPECT_EQ(log::quoted("\x1b[2J\r\t\xc3\xa9").text, R"("\x1b[2J\x0d\t\xc3\xa9")");
}

TEST(Quoted, IsBounded) {
    const auto text = log::quoted(std::string(100'000, '\n')).text;
    EXPECT_LE(text.size(), 4 * kMaxQuoted + 5);
    EXPECT_TRUE(text.ends_with("...\""));
}

TEST(Log, AProgramsNameCannotWriteALineOfItsOwn) {
    begin("walld");
    ::testing::internal::CaptureStderr();
    info("session_open session={} program={}", 3, log::quoted("gears\"\nsession_end session=3"));
    const auto said = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
    EXPECT_NE(said.find(R"(session_open session=3 program="gears\"\nsession_end session=3")"), std::string::npos)
        << said;
}

}  // namespace
}  // namespace wall::log
