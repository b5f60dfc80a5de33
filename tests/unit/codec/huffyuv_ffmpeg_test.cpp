// SPDX-License-Identifier: MIT
// HuffYUV against the real ffmpeg program, bit for bit: it decodes what we write, and we decode what it writes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "common/codec/avi.h"
#include "common/codec/huffyuv.h"
#include "tests/unit/codec/test_pictures.h"

namespace wall::codec::huffyuv {
namespace {

using test::Kind;
namespace fs = std::filesystem;

constexpr Kind kFrames[] = {Kind::noisy_gradient, Kind::noise, Kind::text};  // one after the other in every file

class HuffyuvFfmpeg : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("huffyuv_ffmpeg_test." + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    static void ffmpeg(const std::string& arguments) {
        const std::string command = "ffmpeg -nostdin -v error -y -threads 1 " + arguments;
        ASSERT_EQ(std::system(command.c_str()), 0) << command;
    }
    std::vector<std::byte> content(const std::string& name) const {
        std::ifstream file(path(name), std::ios::binary);
        std::vector<std::byte> out(fs::file_size(path(name)));
        file.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
        return out;
    }
    static std::vector<std::byte> frames(const StreamFormat& format) {
        std::vector<std::byte> out;
        for (const Kind kind : kFrames) {
            const auto bytes = test::bytes_of(test::picture(format, kind).view());
            out.insert(out.end(), bytes.begin(), bytes.end());
        }
        return out;
    }
    /// FFmpeg's name of the same bytes.
    static std::string raw_name(const StreamFormat& format) {
        return format.layout == PixelLayout::yuy2 ? "yuyv422" : "bgra";
    }

    void expect_ffmpeg_decodes(const StreamFormat& format, const EncoderOptions& options) {
        const auto encoder = make_stream_encoder(format, options).value();
        std::optional<AviWriter> writer;
        for (const Kind kind : kFrames) {
            std::vector<std::byte> packet;
            ASSERT_TRUE(encoder->encode(test::picture(format, kind).view(), PacketKind::key, packet));
            if (!writer) {
                AviFormat avi{
                    .width = format.width, .height = format.height, .bit_count = bit_count(encoder->stream())};
                avi.extradata.assign(encoder->stream_header().begin(), encoder->stream_header().end());
                writer.emplace(AviWriter::create(path("ours.avi"), avi).value());
            }
            ASSERT_TRUE(writer->add(packet));
        }
        ASSERT_TRUE(writer->finish());
        ffmpeg("-i " + path("ours.avi") + " -vsync 0 -f rawvideo -pix_fmt " + raw_name(format) + " " +
               path("theirs.raw"));
        EXPECT_EQ(content("theirs.raw"), frames(format));
    }

    void expect_we_decode(const StreamFormat& format, const std::string& pix_fmt, const std::string& options) {
        const auto expected = frames(format);
        std::ofstream(path("frames.raw"), std::ios::binary)
            .write(reinterpret_cast<const char*>(expected.data()), static_cast<std::streamsize>(expected.size()));
        ffmpeg("-f rawvideo -pix_fmt " + raw_name(format) + " -s " + std::to_string(format.width) + "x" +
               std::to_string(format.height) + " -i " + path("frames.raw") + " -c:v huffyuv -pix_fmt " + pix_fmt + " " +
               options + " " + path("theirs.avi"));
        auto reader = AviReader::open(path("theirs.avi")).value();
        const auto stream = read_stream(reader.format().bit_count, reader.format().height, reader.format().extradata);
        ASSERT_TRUE(stream) << stream.error().message;
        const auto decoder = make_stream_decoder(format, *stream).value();
        std::vector<std::byte> decoded;
        for (;;) {
            const auto frame = reader.next();
            ASSERT_TRUE(frame) << frame.error().message;
            if (!*frame) break;
            const auto view = decoder->decode(**frame);
            ASSERT_TRUE(view) << view.error().message;
            const auto bytes = test::bytes_of(*view);
            decoded.insert(decoded.end(), bytes.begin(), bytes.end());
        }
        EXPECT_EQ(decoded, expected) << pix_fmt << " " << options;
    }

    fs::path folder_;
};

constexpr std::pair<std::uint32_t, std::uint32_t> kRgbSizes[] = {{1, 1},   {1, 9},   {2, 1},   {3, 5},
                                                                 {17, 13}, {64, 33}, {19, 290}};
constexpr std::pair<std::uint32_t, std::uint32_t> kYuy2Sizes[] = {{4, 1},   {4, 2},   {8, 3},
                                                                  {20, 17}, {64, 33}, {12, 290}};

TEST_F(HuffyuvFfmpeg, DecodesOurRgb) {
    for (const auto& [width, height] : kRgbSizes) {
        for (const bool alpha : {false, true}) {
            for (const Predictor predictor : {Predictor::left, Predictor::gradient}) {
                for (const bool decorrelate : {true, false}) {
                    const StreamFormat format{width, height, PixelLayout::bgra, alpha};
                    SCOPED_TRACE(test::describe(format, Kind::noise) + " predictor " +
                                 std::to_string(static_cast<int>(predictor)) + (decorrelate ? " decorrelated" : ""));
                    expect_ffmpeg_decodes(format, {predictor, decorrelate});
                }
            }
        }
    }
}

TEST_F(HuffyuvFfmpeg, DecodesOurYuy2) {
    for (const auto& [width, height] : kYuy2Sizes) {
        for (const Predictor predictor : {Predictor::left, Predictor::gradient, Predictor::median}) {
            SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height) + " predictor " +
                         std::to_string(static_cast<int>(predictor)));
            expect_ffmpeg_decodes({width, height, PixelLayout::yuy2}, {predictor});
        }
    }
    expect_ffmpeg_decodes({2, 5, PixelLayout::yuy2}, {Predictor::left});
}

/// Recordings over 1 GiB go on in further RIFF segments; here they are small.
TEST_F(HuffyuvFfmpeg, ReadsOurSegments) {
    const StreamFormat format{64, 48};
    const auto encoder = make_stream_encoder(format, {}).value();
    std::optional<AviWriter> writer;
    std::vector<std::byte> expected;
    for (std::uint32_t i = 0; i < 40; ++i) {
        const auto picture = test::picture(format, Kind::noisy_gradient, i);
        std::vector<std::byte> packet;
        ASSERT_TRUE(encoder->encode(picture.view(), PacketKind::key, packet));
        if (!writer) {
            AviFormat avi{.width = 64, .height = 48, .bit_count = bit_count(encoder->stream())};
            avi.extradata.assign(encoder->stream_header().begin(), encoder->stream_header().end());
            writer.emplace(AviWriter::create(path("ours.avi"), avi, 40000).value());
        }
        ASSERT_TRUE(writer->add(packet));
        const auto bytes = test::bytes_of(picture.view());
        expected.insert(expected.end(), bytes.begin(), bytes.end());
    }
    ASSERT_TRUE(writer->finish());
    ffmpeg("-i " + path("ours.avi") + " -vsync 0 -f rawvideo -pix_fmt bgra " + path("theirs.raw"));
    EXPECT_TRUE(content("theirs.raw") == expected);
    ffmpeg("-ss 1.4 -i " + path("ours.avi") + " -vsync 0 -frames:v 1 -f rawvideo -pix_fmt bgra " +
           path("theirs.raw"));  // by the indexes
    const std::size_t frame = 64 * 48 * 4;
    EXPECT_TRUE(content("theirs.raw") ==
                std::vector<std::byte>(expected.begin() + 35 * frame, expected.begin() + 36 * frame));
}

/// HuffYUV 1.x: no tables in the file. Up to 288 rows; taller files are interlaced, which we do not write.
TEST_F(HuffyuvFfmpeg, DecodesOurClassicTables) {
    for (const auto& [width, height] : {std::pair{3u, 5u}, {64u, 33u}}) {
        for (const bool alpha : {false, true}) {
            expect_ffmpeg_decodes({width, height, PixelLayout::bgra, alpha}, {Predictor::left, true, true});
            expect_ffmpeg_decodes({width, height, PixelLayout::bgra, alpha}, {Predictor::left, false, true});
            expect_ffmpeg_decodes({width, height, PixelLayout::bgra, alpha}, {Predictor::gradient, true, true});
        }
    }
    for (const Predictor predictor : {Predictor::left, Predictor::gradient, Predictor::median})
        expect_ffmpeg_decodes({64, 33, PixelLayout::yuy2}, {predictor, true, true});
}

TEST_F(HuffyuvFfmpeg, WeDecodeItsRgb) {
    for (const auto& [width, height] : kRgbSizes) {
        for (const char* pred : {"-pred left", "-pred plane"}) {
            SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
            expect_we_decode({width, height}, "rgb24", pred);
            expect_we_decode({width, height, PixelLayout::bgra, true}, "bgra", pred);
        }
    }
}

TEST_F(HuffyuvFfmpeg, WeDecodeItsYuv) {
    for (const auto& [width, height] : kYuy2Sizes)
        for (const char* pred : {"-pred left", "-pred plane", "-pred median"}) {
            SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
            expect_we_decode({width, height, PixelLayout::yuy2}, "yuv422p", pred);
        }
}

TEST_F(HuffyuvFfmpeg, WeDecodeItsInterlacedFiles) {
    expect_we_decode({21, 40}, "rgb24", "-pred plane -flags +ilme");
    expect_we_decode({21, 40, PixelLayout::bgra, true}, "bgra", "-pred plane -flags +ilme");
    for (const char* pred : {"-pred left -flags +ilme", "-pred plane -flags +ilme", "-pred median -flags +ilme"})
        expect_we_decode({20, 40, PixelLayout::yuy2}, "yuv422p", pred);
}

}  // namespace
}  // namespace wall::codec::huffyuv
