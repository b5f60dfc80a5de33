// SPDX-License-Identifier: MIT
#include "walld/control/identity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace wall::walld {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSecret = "0123456789abcdef";
constexpr std::uint32_t kStranger = 54321;

class ThePeople : public ::testing::Test {
protected:
    ThePeople() {
        std::ofstream(file_) << kSecret << '\n';
        ::chmod(file_.c_str(), 0600);
        people_.tokens.push_back({"kiosk", file_, Role::user});
        people_.operators.users = {77};
    }
    ~ThePeople() override { std::filesystem::remove_all(folder_); }
    static std::string make_folder() {
        std::string path = "/tmp/wallgl-identity-XXXXXX";
        return ::mkdtemp(path.data());
    }
    std::string folder_ = make_folder();
    std::string file_ = folder_ + "/token";
    config::PeopleConfig people_;
};

TEST_F(ThePeople, AUserOfThisMachineHasANameAndARole) {
    const auto who = *Identities::open(people_, {});
    EXPECT_EQ(who.of(0).name, "root");
    EXPECT_EQ(who.of(::geteuid()).role, Role::operator_);
    EXPECT_EQ(who.of(77).role, Role::operator_);
    EXPECT_EQ(who.of(kStranger).role, Role::none);
    EXPECT_EQ(who.of(kStranger).name, "uid 54321");
}

TEST_F(ThePeople, ATokenStandsForSomebodyElse) {
    const auto who = *Identities::open(people_, {});
    const auto kiosk = who.with_token({}, kSecret);
    ASSERT_TRUE(kiosk);
    EXPECT_EQ(kiosk->text(), "token kiosk");
    EXPECT_EQ(kiosk->role, Role::user);
    EXPECT_EQ(who.with_token(who.of(0), "")->name, "root");
    for (const char* wrong : {"0", "0123456789abcdeF", "0123456789abcdef0"})
        EXPECT_FALSE(who.with_token({}, wrong)) << wrong;
}

TEST_F(ThePeople, OverHttpEverybodyIsAtLeastAViewer) {
    auto who = *Identities::open(people_, {});
    EXPECT_EQ(who.over_http({}, "", true)->role, Role::viewer);
    EXPECT_EQ(who.over_http(who.of(77), "", true)->role, Role::operator_);
    EXPECT_EQ(who.over_http({}, std::string("Bearer ") + kSecret, true)->role, Role::user);
    for (const char* wrong : {"Bearer", "Bearer ", "Bearer x", "Basic eDp5", kSecret})
        EXPECT_FALSE(who.over_http(who.of(77), wrong, true)) << wrong;
    people_.http_role = Role::none;
    EXPECT_EQ(Identities::open(people_, {})->over_http({}, "", true)->role, Role::none);
}

TEST_F(ThePeople, ATokensFileMustBeASecret) {
    const auto why = [&] { return Identities::open(people_, {}).error().message; };
    ::chmod(file_.c_str(), 0640);
    EXPECT_THAT(why(), HasSubstr("token 'kiosk': " + file_ + ": expected a file that only its owner can read"));
    ::chmod(file_.c_str(), 0600);
    std::ofstream(file_) << "short\n";
    EXPECT_THAT(why(), HasSubstr("expected a secret of 16 to 1024 bytes"));
    std::filesystem::remove(file_);
    EXPECT_THAT(why(), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace wall::walld
