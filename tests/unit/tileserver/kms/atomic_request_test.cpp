// SPDX-License-Identifier: MIT
#include "tileserver/kms/atomic_request.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/unit/tileserver/kms/fake_drm.h"

namespace wall::tileserver {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// "OBJECT.PROPERTY=VALUE" of each change.
std::vector<std::string> text_of(const AtomicRequest& request) {
    std::vector<std::string> out;
    for (const auto& [object, property, value] : request.changes())
        out.push_back(std::to_string(object) + "." + test::name_of(property) + "=" + std::to_string(value));
    return out;
}

ScreenPlan first_plan() {
    const auto card = test::two_monitors();
    return {card.connectors[0], card.crtcs[0], card.planes[0]};
}

TEST(AtomicRequest, SetsAMode) {
    AtomicRequest request;
    request.set_mode(first_plan(), BlobId(7));
    request.set_place(first_plan(), test::mode_of(1920, 1080));
    request.set_picture(first_plan(), FramebufferId(9));
    EXPECT_THAT(
        text_of(request),
        UnorderedElementsAre("100.CRTC_ID=200", "200.MODE_ID=7", "200.ACTIVE=1", "300.CRTC_ID=200", "300.SRC_X=0",
                             "300.SRC_Y=0", "300.SRC_W=125829120", "300.SRC_H=70778880", "300.CRTC_X=0", "300.CRTC_Y=0",
                             "300.CRTC_W=1920", "300.CRTC_H=1080", "300.FB_ID=9"));
    EXPECT_FALSE(request.error());
}

TEST(AtomicRequest, PutsRightWhatOthersHaveLeft) {
    auto plan = first_plan();
    plan.crtc.properties["GAMMA_LUT"].value = 55;
    plan.connector.properties["link-status"].value = 1;
    AtomicRequest request;
    request.set_mode(plan, BlobId(7));
    const auto changes = text_of(request);
    EXPECT_EQ(std::ranges::count(changes, "200.GAMMA_LUT=0"), 1);
    EXPECT_EQ(std::ranges::count(changes, "100.link-status=0"), 1);
}

TEST(AtomicRequest, FlipsSeveralByTheirPlanesOnly) {
    const auto card = test::two_monitors();
    AtomicRequest request;
    request.set_picture({card.connectors[0], card.crtcs[0], card.planes[0]}, FramebufferId(8));
    request.set_picture({card.connectors[1], card.crtcs[1], card.planes[1]}, FramebufferId(9));
    EXPECT_THAT(text_of(request), ElementsAre("300.FB_ID=8", "301.FB_ID=9"));
}

TEST(AtomicRequest, EndsASignal) {
    AtomicRequest request;
    request.set_dark(first_plan());
    EXPECT_THAT(text_of(request),
                UnorderedElementsAre("300.FB_ID=0", "300.CRTC_ID=0", "100.CRTC_ID=0", "200.ACTIVE=0", "200.MODE_ID=0"));
}

TEST(AtomicRequest, EndsWhateverIsShown) {
    auto card = test::two_monitors();
    AtomicRequest nothing;
    nothing.set_all_dark(card);
    EXPECT_THAT(nothing.changes(), IsEmpty());
    card.connectors[1].properties["CRTC_ID"].value = 200;
    card.crtcs[0].properties["ACTIVE"].value = 1;
    card.crtcs[0].properties["MODE_ID"].value = 3;
    card.planes[2].properties["FB_ID"].value = 4;
    AtomicRequest request;
    request.set_all_dark(card);
    EXPECT_THAT(text_of(request),
                UnorderedElementsAre("101.CRTC_ID=0", "200.ACTIVE=0", "200.MODE_ID=0", "302.FB_ID=0"));
}

TEST(AtomicRequest, SaysWhichPropertyIsMissing) {
    auto plan = first_plan();
    plan.plane.properties.erase("FB_ID");
    plan.crtc.properties.erase("ACTIVE");
    AtomicRequest request;
    request.set_mode(plan, BlobId(7));
    request.set_picture(plan, FramebufferId(9));
    ASSERT_TRUE(request.error());
    EXPECT_EQ(request.error()->message, "CRTC 200 has no property ACTIVE") << "the first";
}

}  // namespace
}  // namespace wall::tileserver
