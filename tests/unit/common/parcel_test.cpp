// SPDX-License-Identifier: MIT
#include "common/wire/parcel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "common/wire/history_coder.h"

namespace wall::wire {
namespace {

const std::vector<NodeIndex> kRoute{NodeIndex(4), NodeIndex(0), NodeIndex(7)};

std::vector<std::byte> noise(std::size_t bytes, unsigned seed) {
    std::minstd_rand random(seed);
    std::vector<std::byte> out(bytes);
    for (std::byte& b : out) b = static_cast<std::byte>(random() >> 8);
    return out;
}

std::vector<std::byte> piece_of(const ParcelLead& lead, std::span<const std::byte> content) {
    auto out = encode_parcel_lead(lead);
    out.insert(out.end(), content.begin(), content.end());
    return out;
}

ParcelLead lead_of(std::uint32_t number, std::size_t bytes, std::size_t offset) {
    return {number, static_cast<std::uint32_t>(bytes), 0, static_cast<std::uint32_t>(offset), 0, kRoute};
}

/// All pieces of a parcel through a reader.
Result<std::optional<RawBytes>> read_all(ParcelReader& reader, const ParcelLead& whole,
                                         std::span<const std::byte> content, std::size_t piece_bytes) {
    Result<std::optional<RawBytes>> last;
    for (std::size_t at = 0; at < content.size(); at += piece_bytes) {
        ParcelLead lead = whole;
        lead.offset = static_cast<std::uint32_t>(at);
        const auto payload = piece_of(lead, content.subspan(at, std::min(piece_bytes, content.size() - at)));
        const auto piece = read_parcel_piece(payload);
        if (!piece) return tl::unexpected(piece.error());
        last = reader.take(*piece);
        if (!last) break;
    }
    return last;
}

TEST(Parcel, APieceSaysWhatItIsAndGoesAlongItsRoute) {
    const auto content = noise(100, 1);
    auto payload = piece_of(lead_of(9, 300, 200), content);
    for (std::size_t position = 0; position < kRoute.size(); ++position, hand_on_piece(payload)) {
        const auto piece = read_parcel_piece(payload);
        ASSERT_TRUE(piece) << piece.error().message;
        EXPECT_EQ(piece->lead.number, 9u);
        EXPECT_EQ(piece->lead.bytes, 300u);
        EXPECT_EQ(piece->lead.offset, 200u);
        EXPECT_EQ(piece->lead.route, kRoute);
        EXPECT_EQ(piece->lead.position, position);
        EXPECT_EQ(piece->lead.next(), position == 2 ? std::nullopt : std::optional(kRoute[position + 1]));
        EXPECT_TRUE(std::ranges::equal(piece->content, content));
    }
    EXPECT_FALSE(read_parcel_piece(payload)) << "nobody is behind the last one";
}

TEST(Parcel, PiecesBecomeTheBatchThatTheyAreOf) {
    ParcelReader reader;
    for (const std::size_t bytes : {1u, 1000u, 70'000u}) {
        const auto content = noise(bytes, 2);
        const auto whole = read_all(reader, lead_of(static_cast<std::uint32_t>(bytes), bytes, 0), content, 999);
        ASSERT_TRUE(whole && *whole);
        EXPECT_TRUE(std::ranges::equal(**whole, content));
    }
}

TEST(Parcel, MayBeCoded) {
    const std::vector<std::byte> plain(100'000, std::byte{7});
    RawBytes coded;
    const std::array<std::span<const std::byte>, 1> pieces{plain};
    ASSERT_TRUE(HistoryEncoder::create()->encode(pieces, coded));
    ParcelLead lead = lead_of(1, coded.size(), 0);
    lead.plain_bytes = static_cast<std::uint32_t>(plain.size());
    ParcelReader reader;
    const auto whole = read_all(reader, lead, coded, 16);
    ASSERT_TRUE(whole && *whole);
    EXPECT_TRUE(std::ranges::equal(**whole, plain));
    lead.plain_bytes += 1;
    EXPECT_FALSE(read_all(reader, lead, coded, 16)) << "it lies about its size";
    lead.plain_bytes = 100;
    EXPECT_FALSE(read_all(reader, lead, coded, 16));
}

TEST(Parcel, WhatIsMissingIsNoticed) {
    const auto content = noise(100, 3);
    const auto read = [&](ParcelReader& reader, std::uint32_t number, std::size_t offset) {
        const auto payload = piece_of(lead_of(number, 300, offset), content);
        return reader.take(*read_parcel_piece(payload)).has_value();
    };
    ParcelReader reader;
    EXPECT_TRUE(read(reader, 1, 0));
    EXPECT_FALSE(read(reader, 1, 200)) << "a piece is missing";
    EXPECT_FALSE(read(reader, 2, 100)) << "its beginning is missing";
    EXPECT_TRUE(read(reader, 3, 0));
    EXPECT_FALSE(read(reader, 4, 100)) << "it is another one's";
    EXPECT_TRUE(read(reader, 5, 0));
    EXPECT_TRUE(read(reader, 6, 0)) << "who handed on the one before is gone";
    EXPECT_TRUE(read(reader, 6, 100));
}

TEST(Parcel, RefusesWhatCannotBe) {
    const auto refused = [](ParcelLead lead, std::size_t bytes) {
        return !read_parcel_piece(piece_of(lead, std::vector<std::byte>(bytes)));
    };
    EXPECT_FALSE(refused(lead_of(1, 10, 0), 10));
    EXPECT_TRUE(refused(lead_of(1, 10, 0), 11)) << "behind its end";
    EXPECT_TRUE(refused(lead_of(1, 10, 11), 0));
    EXPECT_TRUE(refused(lead_of(1, 0, 0), 0)) << "of nothing";
    EXPECT_TRUE(refused(lead_of(1, kMostParcel + std::size_t{1}, 0), 10));
    ParcelLead lead = lead_of(1, 10, 0);
    lead.plain_bytes = kMostCodedBatch + 1;
    EXPECT_TRUE(refused(lead, 10));
    lead = lead_of(1, 10, 0);
    lead.position = kRoute.size();
    EXPECT_TRUE(refused(lead, 10)) << "for nobody";
    lead = lead_of(1, 10, 0);
    lead.route.assign(kMostHandedTo + 1, NodeIndex(1));
    EXPECT_TRUE(refused(lead, 10));
    lead.route.clear();
    EXPECT_TRUE(refused(lead, 10));
    EXPECT_FALSE(read_awaited(std::vector<std::byte>(7)));
    EXPECT_TRUE(read_awaited(std::vector<std::byte>(8)));
}

TEST(Parcel, ForeignBytesAreReadWithoutHarm) {
    std::minstd_rand random(4);
    ParcelReader reader;
    int taken = 0;
    for (int i = 0; i < 20'000; ++i) {
        auto payload = piece_of(lead_of(1, 64, 0), noise(random() % 80, static_cast<unsigned>(i)));
        for (auto changes = random() % 3; changes > 0; --changes)
            payload[random() % payload.size()] = static_cast<std::byte>(random() >> 8);
        payload.resize(payload.size() - random() % 3);
        const auto piece = read_parcel_piece(payload);
        if (piece && reader.take(*piece)) ++taken;
    }
    EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace wall::wire
