// SPDX-License-Identifier: MIT
#include "common/json/parse_json.h"

#include <gtest/gtest.h>

namespace wall {
namespace {

constexpr JsonLimits kLimits{1 << 20, 16};

std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(ParseJson, GivesWhatIsWellFormed) {
    const auto parsed = parse_json(R"({"id": "3", "rect": [1, 2, 3, 4], "text": "]]\"[["})", kLimits);
    ASSERT_TRUE(parsed) << parsed.error().message;
    EXPECT_EQ(parsed->at("rect").at(3), 4);
    EXPECT_EQ(parsed->at("text"), "]]\"[[");
}

TEST(ParseJson, EveryProperPrefixIsRefused) {
    const std::string text = R"({"a": [1, "b\"[", {"c": null}]})";
    for (std::size_t size = 0; size < text.size(); ++size)
        EXPECT_FALSE(parse_json(text.substr(0, size), kLimits)) << size;
    EXPECT_TRUE(parse_json(text, kLimits));
}

TEST(ParseJson, SixteenLevelsAreEnough) {
    EXPECT_TRUE(parse_json(nested(16), kLimits));
    EXPECT_EQ(parse_json(nested(17), kLimits).error().message,
              "JSON: expected at most 16 arrays and objects in each other");
    std::string objects;
    for (int i = 0; i < 17; ++i) objects += "{\"a\":";
    EXPECT_FALSE(parse_json(objects + "1" + std::string(17, '}'), kLimits));
}

TEST(ParseJson, NoDepthTakesTheStack) {
    // What comes of it would be written by recursion.
    EXPECT_FALSE(parse_json(nested(400'000), kLimits));
    EXPECT_FALSE(parse_json(std::string(400'000, '['), kLimits));
    EXPECT_FALSE(parse_json(std::string(400'000, '{'), kLimits));
}

TEST(ParseJson, BracketsInStringsAndBehindEachOtherAreNotDeep) {
    EXPECT_TRUE(parse_json("\"" + std::string(1000, '[') + "\"", kLimits));
    EXPECT_TRUE(parse_json("[\"\\\"" + std::string(1000, '[') + "\"]", kLimits));
    std::string flat = "[[]";
    for (int i = 0; i < 1000; ++i) flat += ",[{}]";
    EXPECT_TRUE(parse_json(flat + "]", kLimits));
}

TEST(ParseJson, TheSizeIsHeldAgainstTheLimitFirst) {
    const std::string text = "\"" + std::string(98, 'x') + "\"";
    EXPECT_TRUE(parse_json(text, {100, 1}));
    EXPECT_EQ(parse_json(text, {99, 1}).error().message, "JSON: expected at most 99 bytes, got 100");
}

TEST(ParseJson, NothingIsNoJson) {
    for (const char* text : {"", " ", "nul", "{} {}", "\"\xff\"", "]"}) EXPECT_FALSE(parse_json(text, kLimits)) << text;
}

}  // namespace
}  // namespace wall
