// SPDX-License-Identifier: MIT
#include "common/codec/avi.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <random>
#include <sstream>

namespace wall::codec {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class AviTest : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("avi_test." + std::to_string(::getpid()) + "." +
                                               testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
        path_ = (folder_ / "file.avi").string();
    }
    void TearDown() override { fs::remove_all(folder_); }

    static AviFormat format() {
        AviFormat out{.width = 6, .height = 4, .rate = 30000, .scale = 1001};
        out.extradata = {std::byte{1}, std::byte{2}, std::byte{3}};
        return out;
    }
    static std::vector<std::byte> frame(std::uint32_t number) {
        std::mt19937 random(number);
        std::vector<std::byte> out(random() % 300);
        for (auto& byte : out) byte = static_cast<std::byte>(random());
        return out;
    }
    void write(std::uint32_t frames, std::uint64_t segment_bytes = AviWriter::kSegmentBytes, bool finish = true) {
        auto writer = AviWriter::create(path_, format(), segment_bytes).value();
        for (std::uint32_t i = 0; i < frames; ++i) ASSERT_TRUE(writer.add(frame(i), i % 3 == 0));
        if (finish) {
            ASSERT_TRUE(writer.finish());
        }
    }
    std::string content() const {
        std::ifstream file(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    fs::path folder_;
    std::string path_;
};

Result<AviReader> open_bytes(const std::string& bytes) {
    return AviReader::open(std::make_unique<std::istringstream>(bytes), "cut.avi");
}

TEST_F(AviTest, FramesComeBack) {
    write(40);
    auto reader = AviReader::open(path_).value();
    EXPECT_EQ(reader.format().width, 6u);
    EXPECT_EQ(reader.format().height, 4u);
    EXPECT_EQ(reader.format().rate, 30000u);
    EXPECT_EQ(reader.format().scale, 1001u);
    EXPECT_EQ(reader.format().extradata, format().extradata);
    for (std::uint32_t i = 0; i < 40; ++i) EXPECT_EQ(reader.next().value(), frame(i));
    EXPECT_EQ(reader.next().value(), std::nullopt);
}

TEST_F(AviTest, SegmentsComeBackAsOneFile) {
    write(200, 4096);
    const std::string bytes = content();
    EXPECT_NE(bytes.find("AVIX"), std::string::npos);
    auto reader = AviReader::open(path_).value();
    for (std::uint32_t i = 0; i < 200; ++i) EXPECT_EQ(reader.next().value(), frame(i));
    EXPECT_EQ(reader.next().value(), std::nullopt);
}

std::uint32_t u32(const std::string& bytes, std::size_t at) {
    std::uint32_t out;
    std::memcpy(&out, bytes.data() + at, 4);
    return out;
}

TEST_F(AviTest, SizesAndIndexesPointToTheirChunks) {
    write(200, 4096);
    const std::string bytes = content();
    for (std::size_t riff = 0; riff < bytes.size();) {
        ASSERT_EQ(bytes.substr(riff, 4), "RIFF");
        riff += 8 + u32(bytes, riff + 4);
        ASSERT_LE(riff, bytes.size());
    }
    const std::size_t super = bytes.find("indx");
    std::uint32_t frames = 0;
    for (std::uint32_t i = 0; i < u32(bytes, super + 12); ++i) {
        const std::size_t index = u32(bytes, super + 32 + 16 * i);
        ASSERT_EQ(bytes.substr(index, 4), "ix00");
        const std::uint32_t entries = u32(bytes, index + 12), base = u32(bytes, index + 20);
        EXPECT_EQ(entries, u32(bytes, super + 32 + 16 * i + 12));
        for (std::uint32_t k = 0; k < entries; ++k, ++frames) {
            const std::size_t data = base + u32(bytes, index + 32 + 8 * k);
            const std::uint32_t size = u32(bytes, index + 32 + 8 * k + 4);
            ASSERT_EQ(bytes.substr(data - 8, 4), "00dc");
            EXPECT_EQ(size & 0x7fffffff, frame(frames).size());
            EXPECT_EQ(size >> 31 == 0, frames % 3 == 0);
        }
    }
    EXPECT_EQ(frames, 200u);
}

TEST_F(AviTest, CutAnywhereGivesTheWholeFramesBeforeTheCut) {
    write(6, 1200);
    const std::string bytes = content();
    for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
        auto reader = open_bytes(bytes.substr(0, cut));
        if (!reader) {
            EXPECT_THAT(reader.error().message, HasSubstr("cut.avi: "));
            continue;
        }
        std::uint32_t frames = 0;
        for (;;) {
            const auto next = reader->next();
            if (!next) {
                EXPECT_THAT(next.error().message, HasSubstr("cut short at byte " + std::to_string(cut) + " after " +
                                                            std::to_string(frames) + " of 6 frames"));
                break;
            }
            if (!*next) {
                EXPECT_EQ(frames, 6u);  // only indexes were lost
                break;
            }
            EXPECT_EQ(**next, frame(frames++));
        }
    }
}

TEST_F(AviTest, AnUnfinishedFileIsReadableAndSaysSo) {
    write(5, AviWriter::kSegmentBytes, false);
    auto reader = AviReader::open(path_).value();
    for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(reader.next().value(), frame(i));
    EXPECT_THAT(reader.next().error().message, HasSubstr("after 5 whole frames; it was not finished"));
}

TEST_F(AviTest, RefusesWhatIsNoAvi) {
    EXPECT_THAT(AviReader::open((folder_ / "none").string()).error().message, HasSubstr("No such file"));
    EXPECT_THAT(open_bytes("").error().message, HasSubstr("not an AVI file"));
    EXPECT_THAT(open_bytes("RIFF....WAVEfmt ").error().message, HasSubstr("not an AVI file"));
    EXPECT_THAT(AviWriter::create("/nowhere/file.avi", format()).error().message, HasSubstr("cannot be made"));
}

TEST_F(AviTest, RefusesAbsurdSizes) {
    write(1);
    std::string bytes = content();
    const std::uint32_t width = 1u << 20;
    std::memcpy(bytes.data() + bytes.find("strf") + 8 + 4, &width, 4);
    EXPECT_THAT(open_bytes(bytes).error().message, HasSubstr("video of 1048576x4 pixels; expected 1 to 32768 a side"));
}

TEST_F(AviTest, AFullDiskIsAnError) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    auto writer = AviWriter::create("/dev/full", format());
    bool failed = !writer;
    for (int i = 0; !failed && i < 10000; ++i) failed = !writer->add(frame(1));
    EXPECT_TRUE(failed);
}

}  // namespace
}  // namespace wall::codec
