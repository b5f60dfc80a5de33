// SPDX-License-Identifier: MIT
#include "tileserver/kms/flip_track.h"

#include <gmock/gmock.h>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;
using Group = FlipTrack::Group;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr FlipTrack::Clock::time_point kNow{1h};
constexpr FramebufferId kFirst(1), kSecond(2), kOther(9);

TEST(Flips, OfAMomentAreOneGroup) {
    FlipTrack flips(3);
    EXPECT_FALSE(flips.busy());
    flips.take(0, kFirst);
    flips.take(2, kOther);
    EXPECT_TRUE(flips.busy());
    EXPECT_FALSE(flips.in_flight());
    EXPECT_THAT(flips.due(), ElementsAre(Group{0, 2}));
    EXPECT_EQ(flips.waiting(2), kOther);
    EXPECT_EQ(flips.waiting(1), std::nullopt);
    EXPECT_THAT(flips.due(), ElementsAre(Group{0, 2})) << "a driver that is busy is asked again";
    flips.sent({0, 2}, kNow);
    EXPECT_THAT(flips.due(), IsEmpty());
    EXPECT_EQ(flips.longest_flight(kNow + 7ms), 7ms);
    EXPECT_EQ(flips.arrived(0), std::nullopt);
    EXPECT_TRUE(flips.busy()) << "one is still in flight";
    EXPECT_EQ(flips.arrived(2), std::nullopt);
    EXPECT_FALSE(flips.busy());
    EXPECT_EQ(flips.longest_flight(kNow + 7ms), 0ms);
}

TEST(Flips, FreeThePictureBefore) {
    FlipTrack flips(1);
    for (const auto& [picture, before] :
         {std::pair(kFirst, std::optional<FramebufferId>()), std::pair(kSecond, std::optional(kFirst)),
          std::pair(kFirst, std::optional(kSecond))}) {
        flips.take(0, picture);
        flips.sent({0}, kNow);
        EXPECT_EQ(flips.arrived(0), before);
        EXPECT_EQ(flips.arrived(0), std::nullopt) << "once";
    }
}

TEST(Flips, WaitForThoseInFlight) {
    FlipTrack flips(2);
    flips.take(0, kFirst);
    flips.sent({0}, kNow);
    flips.take(1, kOther);
    EXPECT_THAT(flips.due(), IsEmpty());
    flips.arrived(0);
    EXPECT_THAT(flips.due(), ElementsAre(Group{1}));
}

TEST(Flips, GoApartWhereTheDriverWantsIt) {
    FlipTrack flips(2);
    flips.take(0, kFirst);
    flips.take(1, kOther);
    flips.go_apart();
    EXPECT_FALSE(flips.together());
    EXPECT_THAT(flips.due(), ElementsAre(Group{0}, Group{1}));
}

TEST(Flips, OfAMonitorThatIsGoneAreForgotten) {
    FlipTrack flips(2);
    flips.take(0, kFirst);
    flips.take(1, kOther);
    flips.sent({0, 1}, kNow);
    flips.drop(0);
    EXPECT_EQ(flips.arrived(0), std::nullopt) << "the kernel may still tell of it";
    flips.arrived(1);
    EXPECT_FALSE(flips.busy());
    flips.take(0, kSecond);
    flips.drop(0);
    EXPECT_THAT(flips.due(), IsEmpty());
}

}  // namespace
}  // namespace wall::tileserver
