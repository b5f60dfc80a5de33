// SPDX-License-Identifier: MIT
#include "client_lib/follow/middle_distance.h"

#include <gtest/gtest.h>

#include "client_lib/follow/view_use.h"

namespace wall::client {
namespace {

/// As of glFrustum: w is how far something is from the eye, which looks along -z.
constexpr glstate::Mat4 kCamera{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.02f, -1, 0, 0, -2.02f, 0};

geom::Box box_at(float distance, float size) {
    geom::Box out;
    out.add(_mm_setr_ps(-size / 2, -size / 2, -distance - size / 2, 1));
    out.add(_mm_setr_ps(size / 2, size / 2, -distance + size / 2, 1));
    return out;
}

TEST(MiddleDistance, IsTheMeanOfWhatIsSeenAsDepth) {
    MiddleDistance distance;
    EXPECT_EQ(distance.value(), 0) << "nobody knows yet";
    distance.note(kCamera, box_at(4, 1));
    distance.note(kCamera, box_at(12, 1));
    EXPECT_TRUE(distance.finish_frame());
    EXPECT_NEAR(distance.value(), 6, 1e-6) << "1 / 6 is half of 1 / 4 and 1 / 12";
}

TEST(MiddleDistance, StaysWhileASceneMovesALittle) {
    MiddleDistance distance;
    distance.note(kCamera, box_at(10, 1));
    EXPECT_TRUE(distance.finish_frame());
    distance.note(kCamera, box_at(11.5f, 1));
    EXPECT_FALSE(distance.finish_frame());
    EXPECT_NEAR(distance.value(), 10, 1e-6);
    distance.note(kCamera, box_at(30, 1));
    EXPECT_TRUE(distance.finish_frame()) << "another scene";
    EXPECT_NEAR(distance.value(), 30, 1e-5);
    EXPECT_FALSE(distance.finish_frame()) << "a frame without anything";
}

TEST(MiddleDistance, LearnsNothingFromWhatIsAroundTheEye) {
    MiddleDistance distance;
    distance.note(kCamera, box_at(0, 100));
    distance.note(kCamera, box_at(-5, 1));
    distance.note(kCamera, geom::Box{});
    geom::Box anywhere;
    anywhere.make_unbounded();
    distance.note(kCamera, anywhere);
    EXPECT_FALSE(distance.finish_frame());
    EXPECT_EQ(distance.value(), 0);
}

TEST(ViewUse, IsMeasuredAnewOnlyWhereSomebodyWantsIt) {
    const auto box = box_at(5, 1);
    glstate::Projection projection;
    projection.clip_from_object = projection.camera = kCamera;
    const auto frame = [&](ViewUse& use) {
        use.note(projection, &box);
        return use.finish_frame();
    };
    ViewUse use;
    EXPECT_FALSE(use.wanted());
    EXPECT_FALSE(frame(use));
    use.measure(true);
    EXPECT_TRUE(use.wanted());
    use.distance = {};
    EXPECT_TRUE(frame(use)) << "the first time that it is known";
    EXPECT_FALSE(frame(use));
    projection.clip_from_object = glstate::multiply(kCamera, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -45, 1});
    EXPECT_TRUE(frame(use)) << "farther away";
    EXPECT_NEAR(use.distance.value(), 50, 1e-4);
}

}  // namespace
}  // namespace wall::client
