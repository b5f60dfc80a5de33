// SPDX-License-Identifier: MIT
// What holds for every codec of the registry: pictures come back byte for byte, and bad packets give an error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/codec/packed_codec.h"
#include "common/codec/worker_pool.h"
#include "tests/unit/codec/test_pictures.h"

namespace wall::codec {
namespace {

using test::Kind;
using testing::HasSubstr;

class EveryCodec : public testing::TestWithParam<const Codec*> {
protected:
    static std::string name() { return std::string(GetParam()->name); }
};

constexpr std::pair<std::uint32_t, std::uint32_t> kSizes[] = {{1, 1},   {1, 2},     {2, 1},   {1, 130}, {130, 1},
                                                              {3, 5},   {7, 7},     {8, 3},   {63, 65}, {64, 64},
                                                              {65, 63}, {129, 131}, {200, 70}};

/// Encodes and decodes a sequence of frames and expects each back.
void expect_same(const std::string& codec, const StreamFormat& format, const std::vector<Picture>& pictures,
                 const ParallelFor& parallel = {}) {
    const auto encoder = make_encoder(codec, format, parallel).value();
    std::unique_ptr<Decoder> decoder;
    for (const auto& picture : pictures) {
        std::vector<std::byte> packet;
        const auto kind = encoder->encode(picture.view(), PacketKind::delta, packet);
        ASSERT_TRUE(kind) << kind.error().message;
        if (!decoder) {
            EXPECT_EQ(*kind, PacketKind::key);
            decoder = make_decoder(codec, format, encoder->stream_header(), parallel).value();
        }
        const auto view = decoder->decode(packet);
        ASSERT_TRUE(view) << view.error().message;
        ASSERT_EQ(view->layout, format.layout);
        ASSERT_EQ(test::bytes_of(*view), test::bytes_of(picture.view()));
    }
}

// A partial picture of nothing has no bytes, and no bytes have no address.
TEST_P(EveryCodec, GivesBackNothing) {
    const Compressor* const compressor = GetParam()->compressor;
    if (compressor == nullptr) return;
    std::vector<std::byte> packet(compressor->bound(0));
    const auto written = compressor->compress({}, packet);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_TRUE(compressor->restore(std::span(packet).first(*written), {}));
    std::array<std::byte, 1> one{};
    EXPECT_FALSE(compressor->restore(std::span(packet).first(*written), one));
}

TEST_P(EveryCodec, GivesBackEveryPicture) {
    for (const auto& [width, height] : kSizes) {
        for (const PixelLayout layout : {PixelLayout::bgra, PixelLayout::rgba}) {
            for (const bool alpha : {false, true}) {
                const StreamFormat format{width, height, layout, alpha};
                for (const Kind kind : test::kKinds) {
                    SCOPED_TRACE(test::describe(format, kind));
                    std::vector<Picture> pictures;
                    for (std::uint32_t seed = 1; seed <= 2; ++seed)
                        pictures.push_back(test::picture(format, kind, seed));
                    expect_same(name(), format, pictures);
                    if (HasFatalFailure()) return;
                }
            }
        }
    }
}

TEST_P(EveryCodec, GivesBackASequenceOfAllKinds) {
    const StreamFormat format{150, 140};
    std::vector<Picture> pictures;
    for (const Kind kind : test::kKinds)
        for (int times = 0; times < 2; ++times) pictures.push_back(test::picture(format, kind));
    expect_same(name(), format, pictures);
}

TEST_P(EveryCodec, ThreadsChangeNothing) {
    const StreamFormat format{300, 500};
    WorkerPool pool(3);
    const auto alone = make_encoder(name(), format).value();
    const auto together = make_encoder(name(), format, pool.parallel_for()).value();
    for (const Kind kind : test::kKinds) {
        const auto picture = test::picture(format, kind);
        std::vector<std::byte> a, b;
        ASSERT_TRUE(alone->encode(picture.view(), PacketKind::delta, a));
        ASSERT_TRUE(together->encode(picture.view(), PacketKind::delta, b));
        EXPECT_EQ(a, b);
    }
    expect_same(name(), format, {test::picture(format, Kind::text), test::picture(format, Kind::noisy_gradient)},
                pool.parallel_for());
}

TEST_P(EveryCodec, ReadsRowsThroughTheStride) {
    const StreamFormat format{33, 9};
    const auto picture = test::picture(format, Kind::noisy_gradient);
    constexpr std::ptrdiff_t kStride = 33 * 4 + 20;
    std::vector<std::byte> padded(kStride * 9);
    for (std::uint32_t y = 0; y < 9; ++y) std::memcpy(padded.data() + (8 - y) * kStride, picture.view().row(y), 33 * 4);
    const FrameView upside_down{padded.data() + 8 * kStride, 33, 9, -kStride, PixelLayout::bgra};
    std::vector<std::byte> a, b;
    ASSERT_TRUE(make_encoder(name(), format).value()->encode(picture.view(), PacketKind::key, a));
    ASSERT_TRUE(make_encoder(name(), format).value()->encode(upside_down, PacketKind::key, b));
    EXPECT_EQ(a, b);
}

TEST_P(EveryCodec, AlphaThatIsNotKeptDecodesOpaque) {
    StreamFormat format{70, 70, PixelLayout::bgra, true};
    const auto translucent = test::picture(format, Kind::noise);
    format.alpha = false;
    const auto encoder = make_encoder(name(), format).value();
    std::vector<std::byte> packet;
    ASSERT_TRUE(encoder->encode(translucent.view(), PacketKind::key, packet));
    const auto decoder = make_decoder(name(), format, encoder->stream_header()).value();
    const auto view = decoder->decode(packet).value();
    for (std::uint32_t y = 0; y < 70; ++y) {
        for (std::uint32_t x = 0; x < 70; ++x) {
            ASSERT_EQ(std::memcmp(view.row(y) + 4 * x, translucent.view().row(y) + 4 * x, 3), 0);
            ASSERT_EQ(view.row(y)[4 * x + 3], std::byte{255});
        }
    }
}

TEST_P(EveryCodec, RefusesAFrameOfAnotherSize) {
    const auto encoder = make_encoder(name(), {16, 16}).value();
    std::vector<std::byte> packet;
    const auto result = encoder->encode(test::picture({16, 17}, Kind::flat).view(), PacketKind::key, packet);
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().message, HasSubstr("frame of 16x17 pixels in a stream of 16x16"));
    EXPECT_TRUE(packet.empty());
}

TEST_P(EveryCodec, EveryProperPrefixOfAPacketIsRefused) {
    const StreamFormat format{40, 70};
    const auto encoder = make_encoder(name(), format).value();
    std::vector<std::byte> packet;
    ASSERT_TRUE(encoder->encode(test::picture(format, Kind::text).view(), PacketKind::key, packet));
    const auto decoder = make_decoder(name(), format, encoder->stream_header()).value();
    for (std::size_t bytes = 0; bytes < packet.size(); ++bytes) {
        const auto view = decoder->decode(std::span(packet).first(bytes));
        ASSERT_FALSE(view) << bytes << " of " << packet.size();
        EXPECT_THAT(view.error().message, HasSubstr(name()));
    }
    EXPECT_TRUE(decoder->decode(packet)) << "a key packet decodes after failures";
}

TEST_P(EveryCodec, SurvivesFlippedBits) {
    const StreamFormat format{70, 66};
    const auto encoder = make_encoder(name(), format).value();
    std::vector<std::byte> packet;
    ASSERT_TRUE(encoder->encode(test::picture(format, Kind::noisy_gradient).view(), PacketKind::key, packet));
    const auto decoder = make_decoder(name(), format, encoder->stream_header()).value();
    std::mt19937 random(9);
    for (int time = 0; time < 500; ++time) {
        auto broken = packet;
        for (int flips = 0; flips < 3; ++flips)
            broken[random() % (time % 2 == 0 ? broken.size() : std::min<std::size_t>(broken.size(), 64))] ^=
                std::byte(1u << random() % 8);
        const auto view = decoder->decode(broken);
        EXPECT_TRUE(view || !view.error().message.empty());
    }
    EXPECT_EQ(test::bytes_of(decoder->decode(packet).value()),
              test::bytes_of(test::picture(format, Kind::noisy_gradient).view()));
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryCodec, testing::ValuesIn(codecs().begin(), codecs().end()),
                         [](const auto& test) {
                             std::string name(test.param->name);
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(Registry, KnowsItsNames) {
    for (const char* name : {"huffyuv", "huffyuv-tiles", "raw", "lz4", "zstd"})
        EXPECT_EQ((*find_codec(name))->name, name);
    EXPECT_THAT(find_codec("mpeg").error().message,
                HasSubstr("unknown codec 'mpeg'; there are: huffyuv, huffyuv-tiles, raw, lz4, zstd (there is no "));
}

TEST(Registry, RefusesAbsurdSizes) {
    for (const Codec* codec : codecs()) {
        for (const auto& [width, height] :
             {std::pair{0u, 1u}, {1u, 0u}, {kMaxExtent + 1, 1u}, {kMaxExtent, kMaxExtent}, {~0u, ~0u}}) {
            EXPECT_FALSE(make_encoder(codec->name, {width, height}));
            EXPECT_FALSE(make_decoder(codec->name, {width, height}));
        }
    }
    EXPECT_THAT(make_encoder("raw", {3, 3, PixelLayout::yuy2}).error().message, HasSubstr("expected an even width"));
}

}  // namespace
}  // namespace wall::codec
