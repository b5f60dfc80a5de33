// SPDX-License-Identifier: MIT
#include "tools/view/picture_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wall::view {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::uint32_t kBackground = 0x204060ff;  // red first, as pixels are written below

json part(const char* tile, const geom::Rect& at, bool away = false) {
    return {{"tile", tile}, {"rect", {at.x, at.y, at.width, at.height}}, {"away", away}};
}

class PictureBuilderTest : public ::testing::Test {
protected:
    Result<void> tell(json text) { return builder_.take_text(text.dump()); }
    Result<void> parts(std::vector<json> list, std::uint32_t width = 5, std::uint32_t height = 2) {
        return tell({{"stream", 0},
                     {"codec", "raw"},
                     {"layout", "rgba"},
                     {"width", width},
                     {"height", height},
                     {"shows", {0, 0, width, height}},
                     {"background", "#204060"},
                     {"parts", list}});
    }
    Result<void> header(int number) { return tell({{"stream", 0}, {"part", number}, {"header", ""}}); }
    /// All of one colour, 0xRRGGBBAA.
    Result<void> frame(std::uint32_t number, std::uint32_t width, std::uint32_t height, std::uint32_t color) {
        const codec::StreamFormat format{width, height, codec::PixelLayout::rgba, false};
        codec::Picture picture(format);
        for (std::size_t i = 0; i < picture.bytes().size(); ++i)
            picture.bytes()[i] = static_cast<std::byte>(color >> (24 - 8 * (i % 4)));
        std::vector<std::byte> packet;
        EXPECT_TRUE((*codec::make_encoder("raw", format))->encode(picture.view(), codec::PacketKind::key, packet));
        std::string message(24, '\0');
        message[4] = static_cast<char>(number);
        message.append(reinterpret_cast<const char*>(packet.data()), packet.size());
        return builder_.take_frame(message);
    }
    std::uint32_t at(std::uint32_t x, std::uint32_t y) const {
        const auto view = builder_.picture().view();
        std::uint32_t out = 0;
        for (int i = 0; i < 4; ++i)
            out = out << 8 | static_cast<std::uint32_t>(view.row(y)[4 * x + static_cast<std::uint32_t>(i)]);
        return out;
    }
    PictureBuilder builder_;
};

TEST_F(PictureBuilderTest, PartsLieWhereWalldSays) {
    EXPECT_FALSE(builder_.complete());
    ASSERT_TRUE(parts({part("l", {0, 0, 2, 2}), part("r", {3, 0, 2, 2})}));
    ASSERT_TRUE(header(0));
    ASSERT_TRUE(header(1));
    ASSERT_TRUE(frame(1, 2, 2, 0x112233ff));
    EXPECT_FALSE(builder_.complete());
    ASSERT_TRUE(frame(0, 2, 2, 0x445566ff));
    EXPECT_TRUE(builder_.complete());
    EXPECT_EQ(at(1, 1), 0x445566ffu);
    EXPECT_EQ(at(2, 1), kBackground);
    EXPECT_EQ(at(3, 0), 0x112233ffu);
}

TEST_F(PictureBuilderTest, ATileThatIsAwayIsBackgroundUntilItIsBack) {
    ASSERT_TRUE(parts({part("l", {0, 0, 2, 2}, true)}));
    EXPECT_TRUE(builder_.complete());
    ASSERT_TRUE(header(0));
    EXPECT_FALSE(builder_.complete());
    ASSERT_TRUE(frame(0, 2, 2, 0x445566ff));
    EXPECT_TRUE(builder_.complete());
    ASSERT_TRUE(tell({{"stream", 0}, {"part", 0}, {"ended", "node left is away"}}));
    EXPECT_EQ(at(0, 0), kBackground);
    EXPECT_FALSE(frame(0, 2, 2, 0x445566ff)) << "its header must come first";
}

TEST_F(PictureBuilderTest, AWindowKeepsItsPictureUntilItsNewPartsCome) {
    ASSERT_TRUE(parts({part("l", {0, 0, 5, 2})}));
    ASSERT_TRUE(header(0));
    ASSERT_TRUE(frame(0, 5, 2, 0x445566ff));
    ASSERT_TRUE(parts({part("l", {0, 0, 2, 2}), part("r", {2, 0, 2, 2})}));
    EXPECT_EQ(at(3, 1), 0x445566ffu);
    EXPECT_EQ(at(4, 1), kBackground) << "off the canvas";
    EXPECT_FALSE(builder_.complete());
    ASSERT_TRUE(parts({part("l", {0, 0, 3, 3})}, 3, 3));
    EXPECT_EQ(at(0, 0), kBackground) << "another size";
}

TEST_F(PictureBuilderTest, AWindowThatIsGoneLeavesTheBackground) {
    ASSERT_TRUE(parts({part("l", {0, 0, 5, 2})}));
    ASSERT_TRUE(header(0));
    ASSERT_TRUE(frame(0, 5, 2, 0x445566ff));
    ASSERT_TRUE(tell({{"stream", 0}, {"ended", "there is no session 3"}}));
    EXPECT_EQ(builder_.ended(), "there is no session 3");
    EXPECT_FALSE(builder_.complete());
    EXPECT_EQ(at(0, 0), kBackground);
}

TEST_F(PictureBuilderTest, RefusesWhatDoesNotFit) {
    EXPECT_EQ(tell({{"error", "watch[0]: no"}}).error().message, "walld refused: watch[0]: no");
    EXPECT_EQ(tell({{"error", ""}}).error().message, "walld refused: ");
    EXPECT_FALSE(builder_.take_text("{"));
    EXPECT_FALSE(parts({part("l", {0, 0, 6, 2})}));
    EXPECT_FALSE(parts({part("l", {-1, 0, 2, 2})}));
    EXPECT_FALSE(parts({part("l", {INT32_MAX, 0, 1, 1})}));
    EXPECT_FALSE(parts({part("l", {1, 1, INT32_MAX, INT32_MAX})}));
    EXPECT_FALSE(parts({}, 0, 5));
    EXPECT_FALSE(parts({}, 40000, 40000));
    ASSERT_TRUE(parts({part("l", {0, 0, 2, 2})}));
    EXPECT_FALSE(header(1));
    EXPECT_FALSE(frame(0, 2, 2, 0));
    ASSERT_TRUE(header(0));
    EXPECT_FALSE(frame(0, 1, 2, 0));
    EXPECT_FALSE(frame(1, 2, 2, 0));
    EXPECT_THAT(tell({{"parts", json::array()}, {"width", 1e300}, {"height", 2}}).error().message,
                HasSubstr("expected an integer from 0 to 16777216, not 1e+300"));
    EXPECT_THAT(builder_.take_frame("short").error().message, HasSubstr("a frame of 5 bytes"));
}

TEST_F(PictureBuilderTest, PartsThatAreWrongChangeNothing) {
    ASSERT_TRUE(parts({part("l", {0, 0, 5, 2})}));
    ASSERT_TRUE(header(0));
    EXPECT_FALSE(
        tell({{"codec", 7}, {"width", 1}, {"height", 1}, {"background", "#204060"}, {"parts", json::array()}}));
    EXPECT_FALSE(tell({{"codec", "raw"}, {"width", 1}, {"height", 1}, {"background", "#"}, {"parts", json::array()}}));
    ASSERT_TRUE(frame(0, 5, 2, 0x112233ff));  // still of the size that its parts were told for
    EXPECT_EQ(at(4, 1), 0x112233ffu);
}

}  // namespace
}  // namespace wall::view
