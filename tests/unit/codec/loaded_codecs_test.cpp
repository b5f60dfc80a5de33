// SPDX-License-Identifier: MIT
// Codecs out of shared objects: the example's, and some that are no good.
#include "common/codec/loaded_codecs.h"

#include <gmock/gmock.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "common/codec/packed_codec.h"

namespace wall::codec {
namespace {

using ::testing::HasSubstr;

class LoadedCodecs : public testing::Test {
protected:
    static void look_in(const std::filesystem::path& folder) { ::setenv("WALLGL_CODECS", folder.c_str(), 1); }
    void SetUp() override { look_in(ODD_FOLDER); }
    static std::string error_of(std::string_view name) {
        const auto found = find_codec(name);
        return found ? "" : found.error().message;
    }
    static std::vector<std::byte> picture_bytes() {
        std::vector<std::byte> bytes(4003);
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i % 4 * 60 + i / 400);
        return bytes;
    }
};

TEST_F(LoadedCodecs, AreFoundByTheirNamesAndRestoreWhatTheyPressed) {
    look_in(EXAMPLE_FOLDER);
    const auto codec = find_codec("plz4");
    ASSERT_TRUE(codec) << codec.error().message;
    EXPECT_EQ((*codec)->summary, "LZ4 over the planes of four-byte pixels");
    const auto& compressor = *(*codec)->compressor;
    for (const std::size_t size : {std::size_t{0}, std::size_t{3}, std::size_t{4003}}) {
        auto plain = picture_bytes();
        plain.resize(size);
        std::vector<std::byte> coded(compressor.bound(size));
        const auto written = compressor.compress(plain, coded);
        ASSERT_TRUE(written) << written.error().message;
        coded.resize(*written);
        std::vector<std::byte> again(size);
        ASSERT_TRUE(compressor.restore(coded, again));
        EXPECT_EQ(again, plain);
        EXPECT_LT(coded.size(), size / 10 + 20);
    }
    const auto encoder = make_encoder("plz4", {17, 5});
    const auto decoder = make_decoder("plz4", {17, 5});
    ASSERT_TRUE(encoder && decoder);
    Picture picture({17, 5});
    std::ranges::fill(picture.bytes(), std::byte{99});
    std::vector<std::byte> packet;
    ASSERT_TRUE((*encoder)->encode(picture.view(), PacketKind::key, packet));
    EXPECT_TRUE((*decoder)->decode(packet));
    EXPECT_FALSE((*decoder)->decode(std::span(packet).first(packet.size() / 2)));
    EXPECT_EQ(*find_codec("plz4"), *codec) << "it is loaded once";
}

TEST_F(LoadedCodecs, ThatFailOrLieAreToldSo) {
    const auto plain = picture_bytes();
    for (const auto& [name, compressing, restoring] :
         {std::tuple{"fails", "fails: compression failed", "fails: packet of"},
          {"lies", "lies: it says that it has written", ""},
          {"overruns", "overruns: it has written more than it may", "overruns: it has written more than it may"}}) {
        const auto codec = find_codec(name);
        ASSERT_TRUE(codec) << codec.error().message;
        const auto& compressor = *(*codec)->compressor;
        std::vector<std::byte> room(compressor.bound(plain.size()));
        const auto written = compressor.compress(plain, room);
        ASSERT_FALSE(written);
        EXPECT_THAT(written.error().message, HasSubstr(compressing));
        std::vector<std::byte> again(plain.size());
        const auto restored = compressor.restore(plain, again);
        EXPECT_THAT(restored ? "" : restored.error().message, HasSubstr(restoring));
    }
}

TEST_F(LoadedCodecs, ThatAreNoneAreRefusedWithTheReason) {
    EXPECT_THAT(error_of("of-another-version"), HasSubstr("made for version 2"));
    EXPECT_THAT(error_of("of-another-name"), HasSubstr("expected 'of-another-name'"));
    EXPECT_THAT(error_of("incomplete"), HasSubstr("functions is missing"));
    EXPECT_THAT(error_of("nowhere"), HasSubstr("there are: huffyuv"));
    const auto folder = std::filesystem::temp_directory_path() / ("wallgl-codecs-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "text.so") << "no object";
    look_in(folder);
    EXPECT_THAT(error_of("text"), HasSubstr("text.so"));
    std::filesystem::remove_all(folder);
    for (const char* name : {"../plz4", "a/b", "", "UPPER", ".."})
        EXPECT_THAT(error_of(name), HasSubstr("unknown codec"));
}

}  // namespace
}  // namespace wall::codec
