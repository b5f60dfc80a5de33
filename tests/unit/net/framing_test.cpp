// SPDX-License-Identifier: MIT
#include "common/net/framing.h"

#include <gtest/gtest.h>
#include <algorithm>

#include <cstring>
#include <random>

#include "common/wire/limits.h"

namespace wall::net {
namespace {

proto::Envelope rendered(std::uint32_t frame) {
    proto::Envelope out;
    out.mutable_rendered()->set_frame(frame);
    return out;
}

void feed(Unframer& unframer, std::string_view bytes) {
    std::ranges::copy(bytes, reinterpret_cast<char*>(unframer.prepare(bytes.size()).data()));
    unframer.commit(bytes.size());
}

TEST(Framing, GivesBackWhatWasFramedInAnyPortions) {
    const std::string bytes = *frame(rendered(1)) + *frame(rendered(2)) + *frame(rendered(3));
    for (std::size_t portion = 1; portion <= bytes.size(); ++portion) {
        Unframer unframer;
        std::uint32_t seen = 0;
        for (std::size_t at = 0; at < bytes.size(); at += portion) {
            feed(unframer, std::string_view(bytes).substr(at, portion));
            for (auto message = unframer.next(); message && *message; message = unframer.next())
                EXPECT_EQ((*message)->rendered().frame(), ++seen);
        }
        EXPECT_EQ(seen, 3u);
        EXPECT_TRUE(unframer.at_boundary());
    }
}

TEST(Framing, EveryProperPrefixIsIncomplete) {
    const std::string bytes = *frame(rendered(7));
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        Unframer unframer;
        feed(unframer, bytes.substr(0, length));
        const auto message = unframer.next();
        ASSERT_TRUE(message);
        EXPECT_FALSE(*message);
        EXPECT_EQ(unframer.at_boundary(), length == 0);
    }
}

TEST(Framing, RefusesAnOversizedMessageBeforeItCame) {
    Unframer unframer;
    const std::uint32_t bytes = wire::kMaxControlMessage + 1;
    feed(unframer, std::string_view(reinterpret_cast<const char*>(&bytes), sizeof bytes));
    EXPECT_FALSE(unframer.next());
}

TEST(Framing, AMessageThatNobodyWouldTakeIsAnError) {
    proto::Envelope large;
    large.mutable_snapshot()->set_rgb(std::string(wire::kMaxControlMessage, 'x'));
    const auto framed = frame(large);
    ASSERT_FALSE(framed);
    EXPECT_NE(framed.error().message.find("the limit is 67108864"), std::string::npos) << framed.error().message;
    EXPECT_FALSE(frame(proto::Envelope()));
}

TEST(Framing, AFailureIsFinal) {
    Unframer unframer;
    feed(unframer, std::string_view("\0\0\0\0", 4));
    EXPECT_FALSE(unframer.next());
    feed(unframer, *frame(rendered(1)));
    EXPECT_FALSE(unframer.next());
}

TEST(Framing, RefusesWhatIsNoEnvelopeOrAnUnknownOne) {
    using namespace std::string_literals;
    for (const auto& body : {"\xff\xff\xff"s, "\x0a\x7f"s, "\xc2\x3e\x00"s /* field 1000 */}) {
        Unframer unframer;
        const auto bytes = static_cast<std::uint32_t>(body.size());
        feed(unframer, std::string(reinterpret_cast<const char*>(&bytes), 4) + body);
        EXPECT_FALSE(unframer.next());
    }
}

/// Nobody fills the log of a daemon with what it refuses.
TEST(Framing, IsQuietAboutTextsThatAreNone) {
    using namespace std::string_literals;
    const auto body = "\x0a\x03\x1a\x01\xff"s;  // ClientHello.program
    const auto bytes = static_cast<std::uint32_t>(body.size());
    Unframer unframer;
    feed(unframer, std::string(reinterpret_cast<const char*>(&bytes), 4) + body);
    testing::internal::CaptureStderr();
    EXPECT_FALSE(unframer.next());
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Framing, SurvivesGarbage) {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        Unframer unframer;
        std::string bytes = *frame(rendered(static_cast<std::uint32_t>(round)));
        bytes[random() % bytes.size()] = static_cast<char>(random());
        bytes += static_cast<char>(random());
        feed(unframer, bytes);
        for (auto message = unframer.next(); message && *message; message = unframer.next()) {
        }
    }
}

}  // namespace
}  // namespace wall::net
