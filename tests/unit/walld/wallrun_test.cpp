// SPDX-License-Identifier: MIT
#include "tools/wallrun/launch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::wallrun {
namespace {

using ::testing::HasSubstr;

TEST(Wallrun, SetsTheEnvironmentThatSelectsTheVendor) {
    const VendorFiles files{"/opt/lib", "/opt/share/50_wallgl.json"};
    const auto set = environment_for({.walld = "unix:/w", .rect = "1,2,3,4", .name = "n", .hold = true}, files, "/other");
    EXPECT_EQ(set.at("__GLX_VENDOR_LIBRARY_NAME"), "wallgl");
    EXPECT_EQ(set.at("__EGL_VENDOR_LIBRARY_FILENAMES"), "/opt/share/50_wallgl.json");
    EXPECT_EQ(set.at("LD_LIBRARY_PATH"), "/opt/lib:/other");
    EXPECT_EQ(set.at("WALLGL_WALLD"), "unix:/w");
    EXPECT_EQ(set.at("WALLGL_RECT"), "1,2,3,4");
    EXPECT_EQ(set.at("WALLGL_NAME"), "n");
    EXPECT_EQ(set.at("WALLGL_HOLD"), "1");
    EXPECT_FALSE(environment_for({}, files, "").contains("WALLGL_RECT"));
}

TEST(Wallrun, ChecksRectangles) {
    for (const char* good : {"", "fullscreen", "0,0,1,1", "-5,0,10,10"}) EXPECT_TRUE(check_rect(good)) << good;
    for (const char* bad : {"1,2,3", "1,2,3,4,5", "1,2,0,4", "1,2,3,-4", "a", "1x2+3+4"}) EXPECT_FALSE(check_rect(bad)) << bad;
}

TEST(Wallrun, SaysWhatIsWrongWithTheVendor) {
    const auto missing = find_vendor("/nowhere/bin/wallrun");
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("/nowhere/lib"));
    EXPECT_FALSE(check_vendor({"/nowhere/lib", "/nowhere/50_wallgl.json"}));
}

TEST(Wallrun, SaysWhereWalldWasLookedFor) {
    const auto result = check_walld("unix:/nowhere/walld.sock");
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().message, HasSubstr("unix:/nowhere/walld.sock: cannot connect: No such file or directory"));
}

}  // namespace
}  // namespace wall::wallrun
