// SPDX-License-Identifier: MIT
#include "walld/wall/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "walld/control/layout_store.h"

namespace wall::walld {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Layout kLayout{1280,
                     480,
                     {{{"", "glxgears", "gears"}, {0, 0, 300, 300}, false, 0},
                      {{"map", "viewer", "Map"}, {-10, 20, 640, 480}, true, 1}}};

TEST(Layout, ComesBackFromItsText) {
    const auto again = parse_layout(to_text(kLayout));
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->width, 1280);
    ASSERT_EQ(again->windows.size(), 2u);
    EXPECT_EQ(again->windows[1].rect, kLayout.windows[1].rect);
    EXPECT_EQ(again->windows[1].window.name, "map");
    EXPECT_FALSE(again->windows[0].scaled);
    EXPECT_EQ(again->windows[1].z, 1u);
}

TEST(Layout, EveryBeginningOfATextIsRefused) {
    auto text = to_text(kLayout);
    text.pop_back();
    for (std::size_t size = 0; size < text.size(); ++size) EXPECT_FALSE(parse_layout(text.substr(0, size))) << size;
}

TEST(Layout, WhatCannotBeIsRefused) {
    for (const char* wrong :
         {"[]", "{}", R"({"version": 2, "canvas": [1, 1], "windows": []})",
          R"({"version": 1, "canvas": [0, 1], "windows": []})", R"({"version": 1, "canvas": [1, 1], "windows": {}})",
          R"({"version": 1, "canvas": [1, 1], "windows": [{}]})",
          R"({"version": 1, "canvas": [1, 1], "windows": )"
          R"([{"name": "", "program": "", "title": "", "rect": [0, 0, 0, 1], "scaled": true}]})",
          R"({"version": 1, "canvas": [1, 1], "windows": )"
          R"([{"name": 1, "program": "", "title": "", "rect": [0, 0, 1, 1], "scaled": true}]})"}) {
        const auto layout = parse_layout(wrong);
        ASSERT_FALSE(layout) << wrong;
        EXPECT_THAT(layout.error().message, HasSubstr("not a layout: "));
    }
}

TEST(Layout, AFileThatIsTooDeepIsRefused) {
    EXPECT_THAT(parse_layout(std::string(1'000'000, '[') + std::string(1'000'000, ']')).error().message,
                HasSubstr("not a layout: JSON: expected at most 16 arrays and objects"));
}

TEST(Layout, FitsAnotherCanvas) {
    const auto twice = scaled_to(kLayout, 2560, 240);
    EXPECT_EQ(twice.windows[0].rect, (geom::Rect{0, 0, 600, 150}));
    EXPECT_EQ(twice.windows[1].rect, (geom::Rect{-20, 10, 1280, 240}));
}

TEST(Layout, PlacesGoToTheBestMatch) {
    std::vector<LayoutEntry> places{{{"", "gears", "left"}, {1, 0, 1, 1}},
                                    {{"", "gears", "right"}, {2, 0, 1, 1}},
                                    {{"map", "viewer", ""}, {3, 0, 1, 1}}};
    EXPECT_FALSE(take_place(places, {"", "atlantis", "left"}));
    EXPECT_FALSE(take_place(places, {"other", "gears", "left"})) << "it has a name of its own";
    EXPECT_EQ(take_place(places, {"", "gears", "right"})->rect.x, 2);
    EXPECT_EQ(take_place(places, {"", "gears", "right"})->rect.x, 1) << "the same program will do";
    EXPECT_EQ(take_place(places, {"map", "another viewer", "x"})->rect.x, 3) << "a name is enough";
    EXPECT_TRUE(places.empty());
}

class Store : public ::testing::Test {
protected:
    ~Store() override { std::filesystem::remove_all(folder_); }
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ + "/layouts/" + name) << text;
    }
    static std::string make_folder() {
        std::string path = "/tmp/wallgl-layouts-XXXXXX";
        return ::mkdtemp(path.data());
    }
    std::string folder_ = make_folder();
    LayoutStore store_{folder_};
};

TEST_F(Store, KeepsLayoutsByName) {
    EXPECT_THAT(*LayoutStore(folder_).list(), ElementsAre());
    ASSERT_TRUE(store_.save("night", kLayout));
    ASSERT_TRUE(store_.save("day", {100, 100, {}}));
    ASSERT_TRUE(store_.save("day", kLayout)) << "replaced";
    EXPECT_THAT(*LayoutStore(folder_).list(), ElementsAre("day", "night"));
    EXPECT_EQ(LayoutStore(folder_).load("day")->windows.size(), 2u);
    ASSERT_TRUE(store_.remove("day"));
    EXPECT_EQ(store_.remove("day").error().kind, RefusalKind::not_found);
    EXPECT_EQ(store_.load("day").error().kind, RefusalKind::not_found);
}

TEST_F(Store, NamesAreNoPaths) {
    for (const std::string name : {"", ".", "..", "../x", "a/b", ".hidden", "a b", "a\n"}) {
        EXPECT_EQ(store_.save(name, kLayout).error().kind, RefusalKind::invalid) << name;
        EXPECT_EQ(store_.load(name).error().kind, RefusalKind::invalid) << name;
        EXPECT_EQ(store_.remove(name).error().kind, RefusalKind::invalid) << name;
    }
    EXPECT_EQ(store_.save(std::string(65, 'a'), kLayout).error().kind, RefusalKind::invalid);
}

TEST_F(Store, ABadFileIsNamedAndLeftAlone) {
    ASSERT_TRUE(store_.save("good", kLayout));
    write("bad.json", "{");
    const auto bad = store_.load("bad");
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().kind, RefusalKind::failed);
    EXPECT_THAT(bad.error().message, HasSubstr("/layouts/bad.json: not a layout: "));
    write("half.json.new", "{");
    EXPECT_THAT(*store_.list(), ElementsAre("bad", "good")) << "what a crash left behind is none";
}

TEST_F(Store, WhereNothingCanBeWrittenItSaysSo) {
    EXPECT_EQ(LayoutStore("").save("a", kLayout).error().kind, RefusalKind::unavailable);
    EXPECT_EQ(LayoutStore("").list().error().kind, RefusalKind::unavailable);
    std::ofstream(folder_ + "/layouts") << "a file";
    EXPECT_EQ(store_.save("a", kLayout).error().kind, RefusalKind::failed);
}

}  // namespace
}  // namespace wall::walld
