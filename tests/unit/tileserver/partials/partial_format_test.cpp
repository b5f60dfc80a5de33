// SPDX-License-Identifier: MIT
#include "tileserver/partials/partial_format.h"

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <random>

namespace wall::tileserver {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr PartialKey kKey{SurfaceId(3), 17, 6, NodeIndex(2), 5};

/// As a layer reads it: depths of 24 bits, and what was drawn marked by the stencil value.
std::uint32_t drawn(std::uint32_t depth) { return depth << 8 | 1; }
constexpr std::uint32_t kUndrawn = 0xffffff00;

PixelBlock block_of(int width, int height, std::vector<std::uint32_t> colors, std::vector<std::uint32_t> depths) {
    return {{10, 20, width, height}, false, std::move(colors), std::move(depths)};
}

PixelBlock random_block(int width, int height, unsigned drawn_of_eight, std::mt19937& random) {
    PixelBlock block{{0, 0, width, height}, false, {}, {}};
    for (std::size_t i = 0; i < block.pixels(); ++i) {
        const auto value = static_cast<std::uint32_t>(random());
        block.colors.push_back(value);
        block.depths.push_back(random() % 8 < drawn_of_eight ? drawn(value % 5) : kUndrawn);
    }
    return block;
}

Partial decoded(const std::vector<std::byte>& message) {
    const auto partial = decode_partial(message);
    EXPECT_TRUE(partial) << partial.error().message;
    return partial.value_or(Partial{});
}

TEST(APartialPicture, HasWhatWasDrawnAndNothingElse) {
    const PixelBlock block =
        block_of(3, 2, {1, 2, 3, 4, 5, 6}, {kUndrawn, drawn(7), drawn(8), kUndrawn, kUndrawn, drawn(9)});
    const Partial partial = decoded(encode_partial(kKey, block));
    EXPECT_EQ(partial.key, kKey);
    EXPECT_EQ(partial.area, block.area);
    EXPECT_THAT(partial.colors, ElementsAre(2, 3, 6));
    EXPECT_THAT(partial.depths, ElementsAre(drawn(7), drawn(8), drawn(9)));
}

TEST(APartialPicture, ThatIsEmptyIsItsHeader) {
    const PixelBlock block =
        block_of(640, 480, std::vector<std::uint32_t>(640 * 480), std::vector<std::uint32_t>(640 * 480, kUndrawn));
    const auto message = encode_partial(kKey, block);
    EXPECT_EQ(message.size(), kPartialHeader + 8);
    EXPECT_TRUE(decoded(message).runs.empty());
}

TEST(APartialPicture, IsTheSameByEachCodec) {
    std::mt19937 random(1);
    const PixelBlock block = random_block(97, 61, 5, random);
    const auto plain = encode_partial(kKey, block), coded = encode_partial(kKey, block, "lz4");
    EXPECT_NE(plain, coded);
    EXPECT_EQ(recode_partial(coded, kNoCodec), plain);
    EXPECT_EQ(recode_partial(plain, "lz4"), coded);
    EXPECT_EQ(decoded(coded).colors, decoded(plain).colors);
    EXPECT_EQ(decoded(coded).depths, decoded(plain).depths);
}

TEST(APartialPicture, TakesThePlaceOfWhatLiesBehindIt) {
    const auto func_and_wins = {std::tuple{GL_LESS, true, false, false}, std::tuple{GL_LEQUAL, true, true, false},
                                std::tuple{GL_GREATER, false, false, true}, std::tuple{GL_GEQUAL, false, true, true}};
    for (const auto& [func, nearer, same, farther] : func_and_wins) {
        PixelBlock into = block_of(3, 1, {50, 50, 50}, {5 << 8 | 0x77, 5 << 8 | 0x77, 5 << 8 | 0x77});
        const PixelBlock theirs = block_of(3, 1, {1, 2, 3}, {drawn(4), drawn(5), drawn(6)});
        ASSERT_TRUE(merge(decoded(encode_partial(kKey, theirs)), func, into));
        EXPECT_THAT(into.colors, ElementsAre(nearer ? 1 : 50, same ? 2 : 50, farther ? 3 : 50)) << func;
        EXPECT_THAT(into.depths,
                    ElementsAre((nearer ? 4 : 5) << 8 | 0x77, 5 << 8 | 0x77, (farther ? 6 : 5) << 8 | 0x77))
            << "stencil values stay";
    }
}

/// The depth test, fragment by fragment.
void draw(PixelBlock& into, const PixelBlock& block, GLenum func) {
    for (std::size_t i = 0; i < block.pixels(); ++i) {
        if ((block.depths[i] & 0xff) == 0) continue;
        const std::uint32_t theirs = block.depths[i] >> 8, ours = into.depths[i] >> 8;
        const bool wins = func == GL_LESS ? theirs < ours : func == GL_LEQUAL ? theirs <= ours : theirs > ours;
        if (!wins) continue;
        into.colors[i] = block.colors[i];
        into.depths[i] = (theirs << 8) | (into.depths[i] & 0xff);
    }
}

// Any number of partial pictures, merged in the order in which they were drawn, are what drawing all would have made.
TEST(PartialPictures, MergedInOrderAreWhatOneNodeWouldHaveDrawn) {
    std::mt19937 random(7);
    for (const GLenum func : {GLenum{GL_LESS}, GLenum{GL_LEQUAL}, GLenum{GL_GREATER}})
        for (int round = 0; round < 20; ++round) {
            PixelBlock one = random_block(31, 17, 8, random), merged = one;
            for (int node = 0; node < 4; ++node) {
                // What a node draws in two passes over each pixel is by itself what the test lets through.
                PixelBlock part{one.area, false, std::vector<std::uint32_t>(one.pixels()),
                                std::vector<std::uint32_t>(one.pixels(), func == GL_GREATER ? 0 : 0xffffff00)};
                for (int pass = 0; pass < 2; ++pass) {
                    const PixelBlock fragments = random_block(31, 17, 3, random);
                    draw(one, fragments, func);
                    draw(part, fragments, func);
                    for (std::size_t i = 0; i < part.pixels(); ++i)
                        if ((fragments.depths[i] & 0xff) != 0) part.depths[i] |= 1;
                }
                ASSERT_TRUE(merge(decoded(encode_partial(kKey, part)), func, merged));
            }
            ASSERT_EQ(merged.colors, one.colors) << func;
            ASSERT_EQ(merged.depths, one.depths) << func;
        }
}

TEST(APartialPicture, ThatBlendsHasNoDepths) {
    const PixelBlock block = block_of(3, 1, {0x80402010, 2, 0xff030303}, {drawn(7), kUndrawn, drawn(9)});
    const auto message = encode_partial(kKey, block, kNoCodec, PartialPlanes::colors);
    EXPECT_EQ(encode_partial(kKey, block).size() - message.size(), 2 * sizeof(std::uint32_t));
    const Partial partial = decoded(message);
    EXPECT_THAT(partial.colors, ElementsAre(0x80402010, 0xff030303));
    EXPECT_THAT(partial.depths, ElementsAre());
    PixelBlock into = block_of(3, 1, {0xff6496c8, 0xff6496c8, 0xff6496c8}, {5, 6, 7});
    EXPECT_FALSE(merge(partial, GL_LESS, into)) << "it has none to be tested";
    ASSERT_TRUE(merge(partial, GL_BLEND, into));
    // 0x80 of 255 covers; what is left of c is c * 127 / 255.
    EXPECT_THAT(into.colors,
                ElementsAre(0xff000000u | (0x40 + 50) << 16 | (0x20 + 75) << 8 | (0x10 + 100), 0xff6496c8, 0xff030303));
    EXPECT_THAT(into.depths, ElementsAre(5, 6, 7));
}

/// One after the other, without rounding.
std::array<double, 4> over(const std::array<double, 4>& theirs, const std::array<double, 4>& ours) {
    std::array<double, 4> out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = theirs[i] + (1 - theirs[3]) * ours[i];
    return out;
}

std::array<double, 4> channels(std::uint32_t color) {
    return {(color & 0xff) / 255.0, (color >> 8 & 0xff) / 255.0, (color >> 16 & 0xff) / 255.0, (color >> 24) / 255.0};
}

TEST(PartialPictures, BlendedLieOneOverTheOther) {
    std::mt19937 random(3);
    for (int round = 0; round < 2000; ++round) {
        auto color = static_cast<std::uint32_t>(0xff000000 | random() % 0x1000000);
        auto exact = channels(color);
        PixelBlock into = block_of(1, 1, {color}, {kUndrawn});
        for (int part = 0; part < 4; ++part) {
            const auto alpha = static_cast<std::uint32_t>(random() % 256);
            const auto at_most = [&] {
                return static_cast<std::uint32_t>(random() % (alpha + 1));
            };  // alpha is multiplied into it
            color = alpha << 24 | at_most() << 16 | at_most() << 8 | at_most();
            exact = over(channels(color), exact);
            const PixelBlock block = block_of(1, 1, {color}, {drawn(1)});
            ASSERT_TRUE(merge(decoded(encode_partial(kKey, block)), GL_BLEND, into));
        }
        const auto merged = channels(into.colors[0]);
        for (std::size_t i = 0; i < 4; ++i) ASSERT_NEAR(merged[i], exact[i], 4 * 0.51 / 255) << round << " " << i;
    }
}

TEST(APartialPicture, FitsRowsInTheOtherOrder) {
    const PixelBlock theirs =
        block_of(2, 3, {1, 2, 3, 4, 5, 6}, {drawn(0), drawn(0), kUndrawn, drawn(0), drawn(0), drawn(0)});
    PixelBlock into = block_of(2, 3, std::vector<std::uint32_t>(6), std::vector<std::uint32_t>(6, kUndrawn));
    into.top_row_first = true;
    ASSERT_TRUE(merge(decoded(encode_partial(kKey, theirs)), GL_LESS, into));
    EXPECT_THAT(into.colors, ElementsAre(5, 6, 0, 4, 1, 2));
}

TEST(APartialPicture, OfAnotherAreaOrByNoDepthIsNotMerged) {
    const Partial partial = decoded(encode_partial(kKey, block_of(1, 1, {1}, {drawn(0)})));
    PixelBlock other = block_of(1, 1, {9}, {kUndrawn});
    EXPECT_FALSE(merge(partial, GL_ALWAYS, other));
    other.area.x = 0;
    EXPECT_FALSE(merge(partial, GL_LESS, other));
    EXPECT_THAT(other.colors, ElementsAre(9));
}

std::string error_of(std::span<const std::byte> message) {
    const auto partial = decode_partial(message);
    return partial ? "" : partial.error().message;
}

TEST(APartialPicture, ThatIsDamagedIsRefused) {
    const auto good = encode_partial(kKey, block_of(2, 1, {1, 2}, {drawn(3), drawn(4)}));
    ASSERT_EQ(error_of(good), "");
    const auto with = [&](std::size_t word, std::uint32_t value) {
        auto message = good;
        std::memcpy(message.data() + 4 * word, &value, sizeof value);
        return message;
    };
    EXPECT_THAT(error_of(std::span(good).first(20)), HasSubstr("shorter than its header"));
    EXPECT_THAT(error_of(std::span(good).first(good.size() - 1)), HasSubstr("not as long"));
    EXPECT_THAT(error_of(with(6, 0)), HasSubstr("area"));
    EXPECT_THAT(error_of(with(7, 1u << 30)), HasSubstr("area"));
    EXPECT_THAT(error_of(with(4, 0x7fffffff)), HasSubstr("area")) << "it would end beyond all numbers";
    EXPECT_THAT(error_of(with(5, static_cast<std::uint32_t>(-1))), HasSubstr("area"));
    EXPECT_THAT(error_of(with(9, 0x20707a67)), HasSubstr("unknown codec 'gzp'"));
    EXPECT_THAT(error_of(with(9, 0x66666668)), HasSubstr("unknown codec"));
    EXPECT_THAT(error_of(with(9, 0x20347a6c)), HasSubstr("lz4: packet"));
    EXPECT_THAT(error_of(with(10, 0xffffffff)), HasSubstr("larger"));
    EXPECT_THAT(error_of(with(13, 7)), HasSubstr("counts"));
    EXPECT_THAT(error_of(with(15, 1)), HasSubstr("lead out")) << "a pixel is skipped that is not there";
    EXPECT_THAT(error_of(with(16, 1)), HasSubstr("not those"));
}

TEST(APartialPicture, IsCodedByACodecOfAnyBytes) {
    EXPECT_TRUE(check_partial_codec("none"));
    EXPECT_TRUE(check_partial_codec("lz4"));
    EXPECT_TRUE(check_partial_codec("zstd"));
    EXPECT_THAT(check_partial_codec("huffyuv").error().message, HasSubstr("1 to 4 letters"));
    EXPECT_THAT(check_partial_codec("").error().message, HasSubstr("1 to 4 letters"));
    EXPECT_THAT(check_partial_codec("nope").error().message, HasSubstr("unknown codec 'nope'"));
    const auto plain = encode_partial(kKey, {{0, 0, 2, 1}, false, {7, 8}, {1, 1}});
    EXPECT_EQ(recode_partial(plain, "nope"), plain) << "as it is";
    for (const char* name : {"lz4", "zstd", "raw"}) {
        const auto coded = recode_partial(plain, name);
        EXPECT_NE(coded, plain);
        const auto partial = decode_partial(coded);
        ASSERT_TRUE(partial) << partial.error().message;
        EXPECT_EQ(partial->colors, (std::vector<std::uint32_t>{7, 8}));
        EXPECT_EQ(recode_partial(coded, kNoCodec), plain);
    }
}

}  // namespace
}  // namespace wall::tileserver
