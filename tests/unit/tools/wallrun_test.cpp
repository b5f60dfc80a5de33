// SPDX-License-Identifier: MIT
#include "tools/wallrun/launch.h"
#include "tools/wallrun/members.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::wallrun {
namespace {

using ::testing::HasSubstr;

TEST(Wallrun, SetsTheEnvironmentThatSelectsTheVendor) {
    const VendorFiles files{"/opt/lib", "/opt/share/50_wallgl.json"};
    const auto set =
        environment_for({.walld = "unix:/w", .rect = "1,2,3,4", .name = "n", .hold = true}, files, "/other");
    EXPECT_EQ(set.at("__GLX_VENDOR_LIBRARY_NAME"), "wallgl");
    EXPECT_EQ(set.at("__EGL_VENDOR_LIBRARY_FILENAMES"), "/opt/share/50_wallgl.json");
    EXPECT_EQ(set.at("LD_LIBRARY_PATH"), "/opt/lib:/other");
    EXPECT_EQ(set.at("WALLGL_WALLD"), "unix:/w");
    EXPECT_EQ(set.at("WALLGL_RECT"), "1,2,3,4");
    EXPECT_EQ(set.at("WALLGL_NAME"), "n");
    EXPECT_EQ(set.at("WALLGL_HOLD"), "1");
    EXPECT_FALSE(environment_for({}, files, "").contains("WALLGL_RECT"));
}

TEST(Wallrun, TakesRanksFromMpi) {
    std::map<std::string, std::string> variables{{"PMI_RANK", "1"}, {"PMI_SIZE", "2"}};
    const Environment environment = [&](const char* name) { return variables.contains(name) ? variables[name] : ""; };
    EXPECT_EQ(rank_from_launcher(environment).value(), (MemberRank{1, 2}));
    variables["OMPI_COMM_WORLD_RANK"] = "3";
    EXPECT_EQ(rank_from_launcher(environment).value(), (MemberRank{1, 2})) << "no size with it";
    variables["OMPI_COMM_WORLD_SIZE"] = "4";
    EXPECT_EQ(rank_from_launcher(environment).value(), (MemberRank{3, 4}));
    variables.clear();
    EXPECT_THAT(rank_from_launcher(environment).error().message, HasSubstr("mpirun"));
    EXPECT_EQ(parallel_value("g", {3, 4}).value(), "g:3:4");
    EXPECT_FALSE(parallel_value("", {0, 1}));
    EXPECT_FALSE(parallel_value("g", {4, 4}));
    EXPECT_FALSE(parallel_value("g", {0, 1000}));
    EXPECT_NE(new_group_name("/bin/march"), new_group_name("/bin/march"));
    EXPECT_THAT(new_group_name("/bin/march"), ::testing::StartsWith("march-"));
}

TEST(Wallrun, EndsAllProcessesWhenOneFails) {
    EXPECT_EQ(run_members("g", 3, {"true"}), 0);
    EXPECT_EQ(
        run_members("g", 3, {"/bin/sh", "-c", "case $WALLGL_PARALLEL in g:1:3) exit 7;; *) exec sleep 60;; esac"}), 7);
    EXPECT_EQ(
        run_members("g", 2, {"/bin/sh", "-c", "case $WALLGL_PARALLEL in g:0:2) kill -9 $$;; *) exec sleep 60;; esac"}),
        128 + 9);
    EXPECT_EQ(run_members("g", 2, {"/nowhere/program"}), 127);
}

TEST(Wallrun, ChecksStereo) {
    for (const char* good : {"", "1.5", "-3", "2,40", "25,0.5"}) EXPECT_TRUE(check_stereo(good, false)) << good;
    for (const char* bad : {"x", "1.5,", "26", "1.5,-1", "1,2,3", "1.5 ", "nan", "1,nan"})
        EXPECT_FALSE(check_stereo(bad, false)) << bad;
    EXPECT_TRUE(check_stereo("", true));
    EXPECT_FALSE(check_stereo("1.5", true)) << "the processes draw one picture together";
}

TEST(Wallrun, ChecksCameras) {
    for (const char* good : {"", "viewProjection", "a.b,c[1]"}) EXPECT_TRUE(check_camera(good)) << good;
    for (const char* bad : {"a b", ",", "a,", "-"}) EXPECT_FALSE(check_camera(bad)) << bad;
    Launch launch;
    launch.camera = "a.b,c[1]";
    EXPECT_EQ(environment_for(launch, {}, "").at("WALLGL_CAMERA"), "a.b,c[1]");
}

TEST(Wallrun, ChecksLossyPixels) {
    for (const char* good : {"", "0", "0.25", "16"}) EXPECT_TRUE(check_lossy_pixels(good)) << good;
    for (const char* bad : {"-0.1", "16.1", "nan", "inf", "much", "1 "}) EXPECT_FALSE(check_lossy_pixels(bad)) << bad;
    Launch launch;
    launch.lossy_pixels = "0.25";
    EXPECT_EQ(environment_for(launch, {}, "").at("WALLGL_LOSSY_PIXELS"), "0.25");
    EXPECT_FALSE(environment_for({}, {}, "").contains("WALLGL_LOSSY_PIXELS"));
}

TEST(Wallrun, ChecksRectangles) {
    for (const char* good : {"", "fullscreen", "0,0,1,1", "-5,0,10,10"}) EXPECT_TRUE(check_rect(good)) << good;
    for (const char* bad : {"1,2,3", "1,2,3,4,5", "1,2,0,4", "1,2,3,-4", "a", "1x2+3+4"})
        EXPECT_FALSE(check_rect(bad)) << bad;
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
    EXPECT_THAT(result.error().message,
                HasSubstr("unix:/nowhere/walld.sock: cannot connect: No such file or directory"));
}

}  // namespace
}  // namespace wall::wallrun
