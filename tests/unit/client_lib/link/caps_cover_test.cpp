// SPDX-License-Identifier: MIT
#include "client_lib/link/caps_cover.h"

#include <gmock/gmock.h>

namespace wall::client {
namespace {

using testing::HasSubstr;

Caps promised() {
    return {.vendor = "Mesa",
            .renderer = "llvmpipe",
            .version = "4.5 (Compatibility Profile) Mesa 22.3.6",
            .shading_language_version = "4.50",
            .extensions = "GL_ARB_a GL_ARB_b",
            .limits = {{0x0D33, {16384}}, {0x846D, {1, 255}}, {0x8A34, {16}}}};
}

TEST(CapsCover, AWallThatCanDoAsMuchLacksNothing) {
    EXPECT_EQ(lacking(promised(), promised()), "");
    auto more = promised();
    more.vendor = "Other";
    more.version = "4.6.0 Other";
    more.extensions = "GL_ARB_c GL_ARB_b GL_ARB_a";
    more.limits = {{0x0D33, {32768}}, {0x846D, {0.5, 300}}, {0x8A34, {4}}, {0x1234, {1}}};
    EXPECT_EQ(lacking(more, promised()), "");
}

TEST(CapsCover, NamesWhatIsMissing) {
    auto less = promised();
    less.version = "3.3 Core";
    EXPECT_EQ(lacking(less, promised()), "OpenGL 4.5 (it has 3.3)");
    less = promised();
    less.shading_language_version = "3.30";
    EXPECT_EQ(lacking(less, promised()), "GLSL 4.50 (it has 3.30)");
    less = promised();
    less.extensions = "GL_ARB_a GL_ARB_bb";
    EXPECT_EQ(lacking(less, promised()), "GL_ARB_b");
}

TEST(CapsCover, LimitsMayBeWiderOnly) {
    const std::pair<std::uint32_t, std::vector<double>> tighter[] = {
        {0x0D33, {8192}}, {0x846D, {2, 255}}, {0x846D, {1, 200}}, {0x846D, {1}}, {0x8A34, {64}}};
    for (const auto& [name, values] : tighter) {
        auto less = promised();
        less.limits[name] = values;
        char number[16];
        snprintf(number, sizeof number, "0x%04X", name);
        EXPECT_THAT(lacking(less, promised()), HasSubstr(number));
    }
    auto without = promised();
    without.limits.erase(0x8A34);
    EXPECT_THAT(lacking(without, promised()), HasSubstr("0x8A34"));
}

}  // namespace
}  // namespace wall::client
