// SPDX-License-Identifier: MIT
#include "common/wire/frame_reader.h"

#include <gtest/gtest.h>

#include <cstring>

namespace wall::wire {
namespace {

std::vector<std::byte> frame(FrameKind kind, std::size_t bytes, int fill) {
    const auto header = encode_frame_header({static_cast<std::uint32_t>(bytes), kind});
    std::vector<std::byte> out(header.begin(), header.end());
    out.resize(out.size() + bytes, static_cast<std::byte>(fill));
    return out;
}

/// Feeds in portions of `portion` bytes; the frames that came out.
std::vector<Frame> feed(FrameReader& reader, std::span<const std::byte> bytes, std::size_t portion) {
    std::vector<Frame> frames;
    while (!bytes.empty()) {
        const auto room = reader.prepare();
        const std::size_t now = std::min({portion, bytes.size(), room.size()});
        std::memcpy(room.data(), bytes.data(), now);
        reader.commit(now);
        bytes = bytes.subspan(now);
        for (auto next = reader.next(); next && *next; next = reader.next()) frames.push_back(std::move(**next));
    }
    return frames;
}

class FrameReaderPortions : public ::testing::TestWithParam<std::size_t> {};

TEST_P(FrameReaderPortions, GivesEveryFrameWhole) {
    std::vector<std::byte> bytes;
    const std::vector<std::size_t> sizes = {0, 1, 7, 65'536, 5'000'000, 3};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const auto one = frame(FrameKind::batch, sizes[i], static_cast<int>(i));
        bytes.insert(bytes.end(), one.begin(), one.end());
    }
    FrameReader reader(8 << 20);
    const auto frames = feed(reader, bytes, GetParam());
    ASSERT_EQ(frames.size(), sizes.size());
    for (std::size_t i = 0; i < sizes.size(); ++i)
        EXPECT_EQ(frames[i].payload, RawBytes(sizes[i], static_cast<std::byte>(i))) << i;
}

INSTANTIATE_TEST_SUITE_P(Portions, FrameReaderPortions, ::testing::Values(1000, 65'536, 3'000'000, 100'000'000));

/// As a client codes it; `says`: how many bytes come out.
std::vector<std::byte> coded_frame(HistoryEncoder& encoder, std::span<const std::byte> batch, std::uint32_t says) {
    const auto head = std::as_bytes(std::span(&says, 1));
    RawBytes payload(head.begin(), head.end());
    const std::array pieces{batch};
    EXPECT_TRUE(encoder.encode(pieces, payload));
    return whole_frame(FrameKind::coded, payload);
}

TEST_P(FrameReaderPortions, DecodesWhatIsCoded) {
    auto encoder = HistoryEncoder::create();
    const std::vector<std::byte> large(3'000'000, std::byte{9}), small(70, std::byte{8});
    std::vector<std::byte> bytes;
    const auto add = [&](const std::vector<std::byte>& one) { bytes.insert(bytes.end(), one.begin(), one.end()); };
    add(coded_frame(*encoder, large, 3'000'000));
    add(frame(FrameKind::batch, 5, 1));
    add(coded_frame(*encoder, small, 70));
    add(coded_frame(*encoder, large, 3'000'000));
    FrameReader reader(8 << 20);
    const auto frames = feed(reader, bytes, GetParam());
    ASSERT_EQ(frames.size(), 4u);
    for (const Frame& one : frames) EXPECT_EQ(one.kind, FrameKind::batch);
    EXPECT_EQ(frames[0].payload, RawBytes(3'000'000, std::byte{9}));
    EXPECT_EQ(frames[1].payload, RawBytes(5, std::byte{1}));
    EXPECT_EQ(frames[2].payload, RawBytes(70, std::byte{8}));
    EXPECT_EQ(frames[3].payload, frames[0].payload);
    EXPECT_EQ(reader.batch_frames(), 4u);
}

TEST(FrameReader, RefusesCodedBatchesThatLie) {
    const std::vector<std::byte> batch(5000, std::byte{3});
    const auto refused = [](const std::vector<std::byte>& bytes) {
        FrameReader reader(1 << 20);
        feed(reader, bytes, bytes.size());
        return !reader.next();
    };
    for (const std::uint32_t says : {0u, 4999u, 5001u, (1u << 20) + 1, UINT32_MAX}) {
        auto encoder = HistoryEncoder::create();
        EXPECT_TRUE(refused(coded_frame(*encoder, batch, says))) << says;
    }
    EXPECT_TRUE(refused(frame(FrameKind::coded, 3, 0))) << "no room for the size";
    EXPECT_TRUE(refused(frame(FrameKind::coded, 100, 7))) << "no zstd";
    auto parts = frame(FrameKind::part, 10, 1);
    auto encoder = HistoryEncoder::create();
    const auto coded = coded_frame(*encoder, batch, 5000);
    parts.insert(parts.end(), coded.begin(), coded.end());
    EXPECT_TRUE(refused(parts)) << "not between the parts of a batch";
}

TEST_P(FrameReaderPortions, PutsABatchInPartsTogether) {
    std::vector<std::byte> bytes;
    const auto add = [&](FrameKind kind, std::size_t size, int fill) {
        const auto one = frame(kind, size, fill);
        bytes.insert(bytes.end(), one.begin(), one.end());
    };
    add(FrameKind::part, 3'000'001, 1);
    add(FrameKind::part, 0, 0);
    add(FrameKind::part, 70'000, 2);
    add(FrameKind::batch, 5, 3);
    add(FrameKind::batch, 9, 4);
    FrameReader reader(4 << 20);
    const auto frames = feed(reader, bytes, GetParam());
    ASSERT_EQ(frames.size(), 2u);
    RawBytes whole(3'000'001, std::byte{1});
    whole.insert(whole.end(), 70'000, std::byte{2});
    whole.insert(whole.end(), 5, std::byte{3});
    EXPECT_EQ(frames[0].kind, FrameKind::batch);
    EXPECT_EQ(frames[0].payload, whole);
    EXPECT_EQ(frames[1].payload, RawBytes(9, std::byte{4}));
}

TEST(FrameReader, PutsWhatComesIntoMemoryThatItWasLent) {
    FrameReader reader(8 << 20);
    RawBytes memory(3 << 20, std::byte{9});
    const std::byte* const at = memory.data();
    reader.lend(std::move(memory));
    reader.lend(RawBytes(100));  // it has larger one already
    const auto first = feed(reader, frame(FrameKind::batch, 2 << 20, 1), 100'000);
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].payload.data(), at);
    EXPECT_EQ(first[0].payload, RawBytes(2 << 20, std::byte{1}));
    const auto next = feed(reader, frame(FrameKind::batch, 2 << 20, 2), 100'000);
    ASSERT_EQ(next.size(), 1u);
    EXPECT_NE(next[0].payload.data(), at) << "it was given away with the frame";
}

TEST(FrameReader, ForgetsWhatItWasLentBetweenFrames) {
    FrameReader reader(8 << 20);
    RawBytes memory(3 << 20);
    const std::byte* const at = memory.data();
    reader.lend(std::move(memory));
    const auto bytes = frame(FrameKind::batch, 2 << 20, 1);
    const auto half = static_cast<std::ptrdiff_t>(bytes.size() / 2);
    EXPECT_TRUE(feed(reader, {bytes.begin(), bytes.begin() + half}, 100'000).empty());
    reader.forget_lent();  // not what a frame is coming into
    const auto first = feed(reader, {bytes.begin() + half, bytes.end()}, 100'000);
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].payload.data(), at);
    reader.lend(RawBytes(3 << 20));
    reader.forget_lent();
    const auto next = feed(reader, frame(FrameKind::batch, 9, 2), 100'000);
    ASSERT_EQ(next.size(), 1u);
    EXPECT_LT(next[0].payload.capacity(), std::size_t{1} << 20);
    EXPECT_EQ(next[0].payload, RawBytes(9, std::byte{2}));
}

/// Cut anywhere; then the frame that was not whole comes again.
TEST(FrameReader, BeginsAFrameAgain) {
    std::vector<std::vector<std::byte>> frames = {frame(FrameKind::part, 3000, 1), frame(FrameKind::part, 500, 2),
                                                  frame(FrameKind::batch, 200'000, 3)};
    RawBytes whole(3000, std::byte{1});
    whole.insert(whole.end(), 500, std::byte{2});
    whole.insert(whole.end(), 200'000, std::byte{3});
    std::size_t all = 0;
    for (const auto& one : frames) all += one.size();
    for (std::size_t cut = 0; cut < all; cut += 997) {
        FrameReader reader(1 << 20);
        std::vector<std::byte> bytes;
        for (const auto& one : frames) bytes.insert(bytes.end(), one.begin(), one.end());
        EXPECT_TRUE(feed(reader, std::span(bytes).first(cut), 70'000).empty());
        reader.begin_frame_again();
        std::vector<std::byte> rest;
        for (std::size_t i = reader.batch_frames(); i < frames.size(); ++i)
            rest.insert(rest.end(), frames[i].begin(), frames[i].end());
        const auto came = feed(reader, rest, 70'000);
        ASSERT_EQ(came.size(), 1u) << cut;
        EXPECT_EQ(came[0].payload, whole) << cut;
        EXPECT_EQ(reader.batch_frames(), 3u);
    }
}

TEST(FrameReader, PartsTogetherHaveALimit) {
    FrameReader reader(1);
    reader.set_limits(1000, 2500);
    std::vector<std::byte> bytes;
    for (int i = 0; i < 3; ++i) {
        const auto one = frame(FrameKind::part, 1000, i);
        bytes.insert(bytes.end(), one.begin(), one.end());
    }
    EXPECT_TRUE(feed(reader, bytes, 100).empty());
    const auto refused = reader.next();
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("at most 2500"), std::string::npos) << refused.error().message;
}

TEST(FrameReader, NothingElseStandsWithinABatch) {
    FrameReader reader(1000);
    auto bytes = frame(FrameKind::part, 10, 0);
    const auto other = frame(FrameKind::hello, 10, 0);
    bytes.insert(bytes.end(), other.begin(), other.end());
    EXPECT_TRUE(feed(reader, bytes, 7).empty());
    EXPECT_FALSE(reader.next());
}

TEST(FrameReader, RefusesMoreThanTheLimit) {
    FrameReader reader(100);
    EXPECT_TRUE(feed(reader, frame(FrameKind::hello, 101, 0), 8).empty());
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.next());  // and stays so
}

}  // namespace
}  // namespace wall::wire
