// SPDX-License-Identifier: MIT
// HuffYUV by itself: every mode gives pictures back; bad stream headers are refused with a reason.
#include "common/codec/huffyuv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/codec/test_pictures.h"

namespace wall::codec::huffyuv {
namespace {

using test::Kind;
using testing::HasSubstr;

void expect_same(const StreamFormat& format, const EncoderOptions& options, Kind kind) {
    SCOPED_TRACE(test::describe(format, kind));
    const auto picture = test::picture(format, kind);
    const auto encoder = make_stream_encoder(format, options).value();
    std::vector<std::byte> packet;
    ASSERT_TRUE(encoder->encode(picture.view(), PacketKind::key, packet));
    EXPECT_EQ(packet.size() % 4, 0u);
    auto stream = read_stream(bit_count(encoder->stream()), 2, encoder->stream_header()).value();
    EXPECT_EQ(stream.predictor, encoder->stream().predictor);
    EXPECT_EQ(stream.decorrelate, encoder->stream().decorrelate);
    const auto decoder = make_stream_decoder(format, stream).value();
    const auto view = decoder->decode(packet);
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_EQ(test::bytes_of(*view), test::bytes_of(picture.view()));
}

TEST(Huffyuv, EveryModeOfRgb) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 5u}, {9u, 1u}, {17u, 9u}, {40u, 30u}})
        for (const bool alpha : {false, true})
            for (const Predictor predictor : {Predictor::left, Predictor::gradient})
                for (const bool decorrelate : {false, true})
                    for (const bool classic : {false, true})
                        for (const Kind kind : test::kKinds)
                            if (!classic || decorrelate || predictor == Predictor::left)
                                expect_same({width, height, PixelLayout::bgra, alpha},
                                            {predictor, decorrelate, classic}, kind);
}

TEST(Huffyuv, EveryModeOfYuy2) {
    for (const auto& [width, height] : {std::pair{4u, 1u}, {4u, 5u}, {8u, 2u}, {20u, 11u}})
        for (const Predictor predictor : {Predictor::left, Predictor::gradient, Predictor::median})
            for (const bool classic : {false, true})
                for (const Kind kind : test::kKinds)
                    expect_same({width, height, PixelLayout::yuy2}, {predictor, true, classic}, kind);
    expect_same({2, 3, PixelLayout::yuy2}, {Predictor::gradient, true, false}, Kind::noise);
}

TEST(Huffyuv, LaterFramesMayDifferFromTheFirst) {
    const StreamFormat format{50, 50};
    const auto encoder = make_stream_encoder(format, {}).value();
    std::vector<std::byte> first, second;
    ASSERT_TRUE(encoder->encode(test::picture(format, Kind::flat).view(), PacketKind::key, first));
    const auto header = std::vector(encoder->stream_header().begin(), encoder->stream_header().end());
    ASSERT_TRUE(encoder->encode(test::picture(format, Kind::noise).view(), PacketKind::key, second));
    EXPECT_EQ(header, std::vector(encoder->stream_header().begin(), encoder->stream_header().end()));
    const auto decoder = make_decoder("huffyuv", format, header).value();
    EXPECT_EQ(test::bytes_of(decoder->decode(second).value()),
              test::bytes_of(test::picture(format, Kind::noise).view()));
}

TEST(Huffyuv, ClassicCodesArePrefixCodes) {
    for (const Pixels pixels : {Pixels::yuy2, Pixels::rgb24}) {
        for (const auto& table : classic_tables(pixels)) {
            std::uint64_t used = 0;  // of 2^32
            for (const Code code : table) used += std::uint64_t{1} << (32 - code.length);
            EXPECT_EQ(used, std::uint64_t{1} << 32);
        }
    }
}

TEST(Huffyuv, RefusesWhatTheFormatHasNot) {
    EXPECT_THAT(make_stream_encoder({8, 8}, {Predictor::median}).error().message,
                HasSubstr("median prediction of RGB"));
    EXPECT_THAT(make_stream_encoder({6, 8, PixelLayout::yuy2}, {Predictor::median}).error().message,
                HasSubstr("multiple of 4"));
    EXPECT_THAT(make_stream_encoder({8, 8}, {Predictor::gradient, false, true}).error().message,
                HasSubstr("expected decorrelate"));
}

std::vector<std::byte> header_of(std::initializer_list<int> bytes) {
    std::vector<std::byte> out;
    for (const int byte : bytes) out.push_back(static_cast<std::byte>(byte));
    return out;
}

TEST(Huffyuv, RefusesBadStreamHeaders) {
    const auto reason = [](std::vector<std::byte> header) { return read_stream(24, 100, header).error().message; };
    EXPECT_THAT(reason(header_of({0, 24})), HasSubstr("is not HuffYUV 2.x"));
    EXPECT_THAT(reason(header_of({3, 24, 32, 0})), HasSubstr("method 3"));
    EXPECT_THAT(reason(header_of({0, 20, 32, 0})), HasSubstr("20 bits a pixel; expected 16, 24 or 32"));
    EXPECT_THAT(reason(header_of({0, 24, 0x60, 0})), HasSubstr("per-frame tables"));
    EXPECT_THAT(reason(header_of({0, 24, 32, 0})), HasSubstr("code table 0 ends at symbol 0"));
    EXPECT_THAT(reason(header_of({0, 24, 32, 0, 8})), HasSubstr("code table 0 ends at symbol 0"));
    EXPECT_THAT(reason(header_of({0, 24, 32, 0, 8, 0})), HasSubstr("a run of 0 at symbol 0; expected 1 to 256"));
    EXPECT_THAT(reason(header_of({0, 24, 32, 0, 8, 255, 8, 255})),
                HasSubstr("a run of 255 at symbol 255; expected 1 to 1"));
    EXPECT_THAT(reason(header_of({0, 24, 32, 0, 7, 255, 7 | 32})), HasSubstr("over-full"));
    EXPECT_THAT(read_stream(29, 100, {}).error().message, HasSubstr("method 5 in biBitCount"));
    EXPECT_THAT(make_decoder("huffyuv", {8, 8}).error().message, HasSubstr("no stream header"));
}

}  // namespace
}  // namespace wall::codec::huffyuv
