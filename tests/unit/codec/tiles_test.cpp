// SPDX-License-Identifier: MIT
// What `huffyuv-tiles` promises about sizes and streams; that pictures come back is in registry_test.cpp.
#include "common/codec/tiles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/codec/tiles_tables.h"
#include "tests/unit/codec/test_pictures.h"

namespace wall::codec::tiles {
namespace {

using test::Kind;
using testing::HasSubstr;

std::vector<std::byte> encode(Encoder& encoder, const Picture& picture, PacketKind want) {
    std::vector<std::byte> out;
    EXPECT_TRUE(encoder.encode(picture.view(), want, out));
    return out;
}

TEST(Tiles, AnUnchangedPictureIsOneByte) {
    const StreamFormat format{1920, 1080};
    const auto picture = test::picture(format, Kind::noisy_gradient);
    const auto encoder = make_encoder(format, {}).value();
    const auto decoder = make_decoder(format, {}, {}).value();
    ASSERT_TRUE(decoder->decode(encode(*encoder, picture, PacketKind::key)));
    const auto packet = encode(*encoder, picture, PacketKind::delta);
    EXPECT_EQ(packet.size(), 1u);
    EXPECT_EQ(test::bytes_of(decoder->decode(packet).value()), test::bytes_of(picture.view()));
}

TEST(Tiles, OneChangedPixelCostsAboutItsSlicesModes) {
    const StreamFormat format{1920, 1080};
    auto picture = test::picture(format, Kind::noisy_gradient);
    const auto encoder = make_encoder(format, {}).value();
    const auto decoder = make_decoder(format, {}, {}).value();
    ASSERT_TRUE(decoder->decode(encode(*encoder, picture, PacketKind::key)));
    picture.row(500)[4 * 700] ^= std::byte{1};
    const auto packet = encode(*encoder, picture, PacketKind::delta);
    EXPECT_LT(packet.size(), 40u);
    EXPECT_EQ(test::bytes_of(decoder->decode(packet).value()), test::bytes_of(picture.view()));
}

TEST(Tiles, AFlatPictureCostsAFewBytesASlice) {
    const StreamFormat format{1920, 1080};
    const auto encoder = make_encoder(format, {}).value();
    EXPECT_LT(encode(*encoder, test::picture(format, Kind::flat), PacketKind::key).size(), 17u * 10 + 100);
}

TEST(Tiles, NeverMoreThanTwoPercentOverHuffyuv) {
    for (const auto& [width, height] : {std::pair{640u, 480u}, {300u, 200u}}) {
        for (const bool alpha : {false, true}) {
            const StreamFormat format{width, height, PixelLayout::bgra, alpha};
            for (const Kind kind : test::kKinds) {
                const auto picture = test::picture(format, kind);
                const auto huffyuv = codec::make_encoder("huffyuv", format).value();
                const auto theirs = encode(*huffyuv, picture, PacketKind::key).size() + huffyuv->stream_header().size();
                const auto ours = encode(*make_encoder(format, {}).value(), picture, PacketKind::key).size();
                EXPECT_LE(static_cast<double>(ours), 1.02 * static_cast<double>(theirs))
                    << test::describe(format, kind);
            }
        }
    }
}

TEST(Tiles, ADeltaWithoutItsKeyIsRefused) {
    const StreamFormat format{100, 100};
    const auto encoder = make_encoder(format, {}).value();
    encode(*encoder, test::picture(format, Kind::text), PacketKind::key);
    const auto delta = encode(*encoder, test::picture(format, Kind::noisy_gradient), PacketKind::delta);
    const auto unchanged = encode(*encoder, test::picture(format, Kind::noisy_gradient), PacketKind::delta);
    for (const auto& packet : {delta, unchanged})
        EXPECT_THAT(make_decoder(format, {}, {}).value()->decode(packet).error().message,
                    HasSubstr("expected a key packet"));
}

TEST(Tiles, AfterAFailureOnlyAKeyPacketDecodes) {
    const StreamFormat format{100, 100};
    const auto encoder = make_encoder(format, {}).value();
    const auto decoder = make_decoder(format, {}, {}).value();
    ASSERT_TRUE(decoder->decode(encode(*encoder, test::picture(format, Kind::text), PacketKind::key)));
    const auto next = test::picture(format, Kind::noisy_gradient);
    auto delta = encode(*encoder, next, PacketKind::delta);
    const auto good = delta;
    delta.resize(delta.size() / 2);
    EXPECT_FALSE(decoder->decode(delta));
    EXPECT_FALSE(decoder->decode(good));
    const auto view = decoder->decode(encode(*encoder, next, PacketKind::key));
    ASSERT_TRUE(view);
    EXPECT_EQ(test::bytes_of(*view), test::bytes_of(next.view()));
}

TEST(Tiles, SaysWhatIsWrongAndWhere) {
    const StreamFormat format{100, 100};
    const auto reason = [&](std::initializer_list<int> bytes) {
        std::vector<std::byte> packet;
        for (const int byte : bytes) packet.push_back(static_cast<std::byte>(byte));
        return make_decoder(format, {}, {}).value()->decode(packet).error().message;
    };
    EXPECT_THAT(reason({}), HasSubstr("empty packet"));
    EXPECT_THAT(reason({0x80}), HasSubstr("unknown flags 128"));
    EXPECT_THAT(reason({kKey, 200}), HasSubstr("ends in the size of slice 0"));
    EXPECT_THAT(reason({kKey, 1, 9, 0}), HasSubstr("slices of 10 bytes in a packet with 1 left"));
    EXPECT_THAT(reason({kKey, 0, 0}), HasSubstr("slice 0 is empty in a key packet"));
    EXPECT_THAT(reason({kKey, 1, 1, 0x31, 0x31}), HasSubstr("slice 0 has other modes than its 2 blocks want"));
    EXPECT_THAT(reason({kKey | kTables}), HasSubstr("ends in the tables"));
    EXPECT_THAT(reason({kKey | kTables, 0x0d}), HasSubstr("the main code repeats a length before the first one"));
    EXPECT_THAT(reason({kKey | kTables, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}),
                HasSubstr("the main code has a run of 274 at symbol 548; at most 61 fit"));
    EXPECT_THAT(reason({kKey | kTables, 0x11, 0xf1, 0xff, 0xff, 0xff, 0x27, 0xdf, 0xfe, 0xed, 0xdf, 0x0e}),
                HasSubstr("the main code: code lengths are over-full"));
}

TEST(TilesTables, LengthsComeBack) {
    std::mt19937 random(4);
    for (int time = 0; time < 50; ++time) {
        Counts counts;
        for (auto& count : counts.main)
            count = random() % 4 == 0 ? static_cast<std::uint32_t>(random() % (1u << time % 20)) : 0;
        for (auto& code : counts.others)
            for (auto& count : code) count = time % 3 == 0 ? 0 : static_cast<std::uint32_t>(random() % 5);
        const Lengths lengths = suit(counts);
        std::array<std::byte, kMostTableBytes> bytes{};
        ByteBitWriter to(bytes.data());
        write_lengths(lengths, to);
        ByteBitReader from({bytes.data(), static_cast<std::size_t>(to.finish() - bytes.data())});
        EXPECT_EQ(read_lengths(from).value(), lengths);
        EXPECT_TRUE(from.at_end());
        EXPECT_TRUE(decode_tables(lengths));
    }
}

TEST(TilesFormat, RunsHaveTheirClasses) {
    for (std::uint32_t run = 1; run <= kBlockPixels; ++run) {
        const auto [symbol, extra, extra_bits] = run_class(run);
        ASSERT_LT(symbol, kRest - kRuns);
        ASSERT_LT(extra, 1u << extra_bits);
        const std::uint32_t least =
            symbol < 16 ? symbol + 1 : (1u << (4 + (symbol - 16) / 2)) + (symbol % 2 << (3 + (symbol - 16) / 2)) + 1;
        EXPECT_EQ(least + extra, run);
    }
}

TEST(TilesFormat, SmallDigitsAreMinusOneToTwo) {
    for (std::uint32_t channel : {0u, 8u, 16u}) {
        for (std::uint32_t value = 0; value < 256; ++value) {
            const bool small = value == 255 || value <= 2;
            EXPECT_EQ(small_digits(value << channel) < 64, small);
        }
    }
    EXPECT_EQ(small_digits(0x00020100), 0x39u);
    EXPECT_EQ(small_digits(0x01000000), 64u);
}

}  // namespace
}  // namespace wall::codec::tiles
