// SPDX-License-Identifier: MIT
#include "common/wire/history_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace wall::wire {
namespace {

std::vector<std::byte> noise(std::size_t bytes, unsigned seed) {
    std::minstd_rand random(seed);
    std::vector<std::byte> out(bytes);
    for (std::byte& b : out) b = static_cast<std::byte>(random() >> 8);
    return out;
}

RawBytes encode(HistoryEncoder& encoder, std::span<const std::byte> bytes) {
    RawBytes out;
    const std::array<std::span<const std::byte>, 1> pieces{bytes};
    EXPECT_TRUE(encoder.encode(pieces, out));
    return out;
}

class HistoryCoder : public ::testing::Test {
protected:
    void expect_back(std::span<const std::byte> bytes) {
        RawBytes out;
        const auto coded = encode(*encoder_, bytes);
        last_ = coded.size();
        const auto done = decoder_.decode(coded, bytes.size(), out);
        ASSERT_TRUE(done) << done.error().message;
        ASSERT_EQ(out.size(), bytes.size());
        EXPECT_TRUE(std::equal(out.begin(), out.end(), bytes.begin()));
    }
    std::optional<HistoryEncoder> encoder_ = HistoryEncoder::create();
    HistoryDecoder decoder_;
    std::size_t last_ = 0;
};

TEST_F(HistoryCoder, GivesBackWhatWasEncodedPieceByPiece) {
    for (const std::size_t bytes : {1u, 20u, 3000u, 70'000u, 5'000'000u, 7u}) expect_back(noise(bytes, 1));
    expect_back(std::vector<std::byte>(3'000'000));
}

TEST_F(HistoryCoder, WhatComesAgainCostsNextToNothing) {
    const auto frame = noise(100'000, 2);
    expect_back(frame);
    EXPECT_GE(last_, frame.size());
    for (int i = 0; i < 10; ++i) {
        expect_back(frame);
        EXPECT_LT(last_, frame.size() / 100);
    }
}

TEST_F(HistoryCoder, PiecesAreOneAfterTheOther) {
    const auto all = noise(1000, 3);
    const std::array pieces{std::span(all).first(10), std::span(all).subspan(10, 0), std::span(all).subspan(10)};
    RawBytes coded(1, std::byte{7});
    ASSERT_TRUE(encoder_->encode(pieces, coded));
    EXPECT_EQ(coded[0], std::byte{7}) << "what was there stays";
    RawBytes out(3);
    ASSERT_TRUE(decoder_.decode(std::span(coded).subspan(1), all.size(), out));
    ASSERT_EQ(out.size(), 3 + all.size());
    EXPECT_TRUE(std::equal(out.begin() + 3, out.end(), all.begin()));
}

TEST_F(HistoryCoder, ForeignBytesAreRefused) {
    const auto bytes = noise(5000, 4);
    const auto coded = encode(*encoder_, bytes);
    const auto refused = [](std::span<const std::byte> given, std::size_t size) {
        HistoryDecoder decoder;
        RawBytes out;
        return !decoder.decode(given, size, out);
    };
    EXPECT_FALSE(refused(coded, bytes.size()));
    EXPECT_TRUE(refused(coded, bytes.size() - 1)) << "more comes out";
    EXPECT_TRUE(refused(coded, bytes.size() + 1)) << "less comes out";
    EXPECT_TRUE(refused(std::span(coded).first(coded.size() / 2), bytes.size()));
    EXPECT_TRUE(refused(noise(100, 5), 100));
    EXPECT_TRUE(refused({}, 1));
}

}  // namespace
}  // namespace wall::wire
