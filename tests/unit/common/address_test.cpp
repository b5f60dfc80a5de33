// SPDX-License-Identifier: MIT
#include "common/base/address.h"

#include <gtest/gtest.h>

namespace wall {
namespace {

TEST(Address, ParsesAndPrintsWhatItParsed) {
    for (const char* text :
         {"unix:/run/wallgl/walld.sock", "127.0.0.1:7770", "localhost:0", "[::1]:65535", "render-3:7790"}) {
        const auto address = Address::parse(text);
        ASSERT_TRUE(address) << text;
        EXPECT_EQ(address->text(), text);
    }
}

TEST(Address, RefusesWhatIsNone) {
    for (const char* text :
         {"", "unix:", "host", ":7770", "host:", "host:70000", "host:-1", "host:7x", "::1:7770", "a/b:1"}) {
        const auto address = Address::parse(text);
        ASSERT_FALSE(address) << text;
        EXPECT_NE(address.error().message.find("expected unix:PATH or HOST:PORT"), std::string::npos);
    }
}

TEST(Address, KnowsWhatOnlyThisMachineReaches) {
    for (const char* text : {"unix:/x", "127.0.0.1:1", "127.1.2.3:1", "localhost:1", "[::1]:1"})
        EXPECT_TRUE(Address::parse(text)->local()) << text;
    for (const char* text : {"0.0.0.0:1", "192.168.0.1:1", "[::]:1", "example.org:1", "128.0.0.1:1"})
        EXPECT_FALSE(Address::parse(text)->local()) << text;
}

TEST(Address, TheResolvedOneKnowsItToo) {
    for (const char* text : {"unix:/x", "127.0.0.1:1", "127.1.2.3:1", "[::1]:1"})
        EXPECT_TRUE(resolve(*Address::parse(text))->local()) << text;
    for (const char* text : {"0.0.0.0:1", "192.168.0.1:1", "[::]:1", "[::ffff:127.0.0.1]:1", "128.0.0.1:1"})
        EXPECT_FALSE(resolve(*Address::parse(text))->local()) << text;
}

TEST(Address, RefusesASocketPathThatTheKernelWouldCut) {
    EXPECT_TRUE(resolve({.path = std::string(107, 'x')}));
    EXPECT_FALSE(resolve({.path = std::string(108, 'x')}));
}

}  // namespace
}  // namespace wall
