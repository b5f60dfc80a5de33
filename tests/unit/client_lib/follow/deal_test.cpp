// SPDX-License-Identifier: MIT
#include "client_lib/follow/deal.h"

#include <gmock/gmock.h>

namespace wall::client {
namespace {

using namespace std::chrono_literals;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr NodeIndex kOne(3), kTwo(5), kThree(6);
auto near(double value) { return DoubleNear(value, 1e-9); }

TEST(ThePacesOfNodes, AreTheSameUntilTheyAreMeasured) {
    const NodePaces paces;
    EXPECT_THAT(paces.ends(std::array{kOne, kTwo}), ElementsAre(near(0.5), near(1)));
    EXPECT_THAT(paces.ends({}), IsEmpty());
}

TEST(ThePacesOfNodes, GiveTheQuickOneMore) {
    NodePaces paces;
    paces.note(kOne, 100, 300us);
    paces.note(kTwo, 100, 100us);
    EXPECT_THAT(paces.ends(std::array{kOne, kTwo}), ElementsAre(near(0.25), near(1)));
    EXPECT_THAT(paces.ends(std::array{kOne, kTwo, kThree}), ElementsAre(near(0.2 / 1.1), near(0.8 / 1.1), near(1)))
        << "one that was not measured is as quick as the mean";
}

TEST(ThePacesOfNodes, FollowWhatIsMeasuredSlowly) {
    NodePaces paces;
    for (const NodeIndex node : {kOne, kTwo}) paces.note(node, 1, 100ns);
    paces.note(kOne, 1, 500ns);
    EXPECT_THAT(paces.ends(std::array{kOne, kTwo}), ElementsAre(near(1.0 / 3), near(1)));
    for (int i = 0; i < 50; ++i) paces.note(kOne, 1, 100ns);
    EXPECT_NEAR(paces.ends(std::array{kOne, kTwo})[0], 0.5, 0.001);
    paces.note(kOne, 0, 10s);
    EXPECT_NEAR(paces.ends(std::array{kOne, kTwo})[0], 0.5, 0.001) << "nothing was drawn";
}

TEST(ThePacesOfNodes, LeaveNobodyOut) {
    NodePaces paces;
    paces.note(kOne, 1, 100ns);
    paces.note(kTwo, 1, 100ns);
    paces.note(kThree, 1, 10s);
    const auto ends = paces.ends(std::array{kOne, kTwo, kThree});
    EXPECT_GT(1 - ends[1], 0.005);
}

}  // namespace
}  // namespace wall::client
