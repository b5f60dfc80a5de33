// SPDX-License-Identifier: MIT
#include "tileserver/kms/kms_screens.h"

#include <gmock/gmock.h>

#include "tests/unit/tileserver/kms/fake_drm.h"

namespace wall::tileserver {
namespace {

using test::FakeDrm;
using test::FakeSurfaces;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::uint32_t kBlue = 0x0000ff;

const std::vector<MonitorWish> kBoth{{0, "left", "DP-1", {}}, {1, "right", "DP-2", {}}};
const std::vector<MonitorWish> kThree{{0, "left", "DP-1", {}}, {1, "right", "DP-2", {}}, {2, "third", "HDMI-A-1", {}}};

class Monitors : public ::testing::Test {
protected:
    void open(const std::vector<MonitorWish>& wishes) {
        auto opened = KmsScreens::open(drm, surfaces, wishes, kBlue);
        ASSERT_TRUE(opened) << opened.error().message;
        screens = std::move(*opened);
    }
    std::string refusal_of(const std::vector<MonitorWish>& wishes) {
        const auto opened = KmsScreens::open(drm, surfaces, wishes, kBlue);
        EXPECT_FALSE(opened);
        return opened ? "" : opened.error().message;
    }
    void hear() {
        const auto heard = screens->take_events();
        EXPECT_TRUE(heard) << heard.error().message;
    }
    void arrive() {
        hear();
        drm.beat();
        hear();
        EXPECT_FALSE(screens->busy());
    }
    void draw(std::size_t i) {
        EXPECT_TRUE(screens->select(i));
        const auto swapped = screens->swap(i);
        EXPECT_TRUE(swapped) << swapped.error().message;
        screens->at(i).drawn();
    }
    void draw_both() {
        draw(0);
        draw(1);
        EXPECT_TRUE(screens->show());
    }
    /// "left@DP-1: 1920x1080@60 of DELL", or without a mode what is the matter.
    std::vector<std::string> news() {
        std::vector<std::string> out;
        for (const auto& news : screens->take_news())
            out.push_back(news.tile + "@" + news.connector + ": " +
                          (news.mode.empty() ? news.note : news.mode + " of " + news.monitor));
        return out;
    }

    FakeDrm drm{test::two_monitors()};
    FakeSurfaces surfaces{drm};
    std::unique_ptr<KmsScreens> screens;
};

TEST_F(Monitors, ShowTheBackgroundTogetherWhenTheyAreOpened) {
    open(kBoth);
    EXPECT_THAT(surfaces.cleared, ElementsAre(kBlue, kBlue));
    ASSERT_EQ(drm.committed.size(), 1u);
    EXPECT_EQ(drm.committed[0].kind, CommitKind::mode);
    EXPECT_TRUE(drm.shown_at("DP-1"));
    EXPECT_TRUE(drm.shown_at("DP-2"));
    EXPECT_TRUE(screens->busy());
    arrive();
    EXPECT_THAT(news(),
                ElementsAre("left@DP-1: 1920x1080@60 of DELL U2720Q", "right@DP-2: 1280x1024@60.02 of EIZO L985"));
    EXPECT_EQ(screens->at(0).width(), 1920);
    EXPECT_EQ(screens->at(1).height(), 1024);
    EXPECT_TRUE(screens->at(0).exposed()) << "of the tile nothing is drawn yet";
    EXPECT_EQ(screens->refresh_period().count(), 16'661'113) << "of the faster one";
}

TEST_F(Monitors, ThatNobodyNamesGoDarkBefore) {
    {
        FakeSurfaces others(drm);
        const auto opened = KmsScreens::open(drm, others, kBoth, 0);
        ASSERT_TRUE(opened);
        drm.committed.clear();
        open({{0, "only", "DP-1", {}}});
    }
    ASSERT_EQ(drm.committed.size(), 2u);
    EXPECT_EQ(drm.committed[0].kind, CommitKind::dark);
    EXPECT_TRUE(drm.shown_at("DP-1"));
    EXPECT_FALSE(drm.shown_at("DP-2"));
}

TEST_F(Monitors, ShowPicturesOfAMomentByOneCommit) {
    open(kBoth);
    arrive();
    const auto before = std::pair(drm.shown_at("DP-1"), drm.shown_at("DP-2"));
    drm.committed.clear();
    draw_both();
    ASSERT_EQ(drm.committed.size(), 1u);
    EXPECT_EQ(drm.committed[0].kind, CommitKind::flip);
    EXPECT_THAT(drm.committed[0].objects, ElementsAre(300, 301)) << "the planes, and nothing else";
    EXPECT_NE(drm.shown_at("DP-1"), before.first);
    EXPECT_NE(drm.shown_at("DP-2"), before.second);
    drm.beat(CrtcId(200));
    hear();
    EXPECT_TRUE(screens->busy()) << "the other one is not there yet";
    arrive();
}

TEST_F(Monitors, TakeAsManyPicturesAsTheyLike) {
    open(kBoth);
    arrive();
    for (int frame = 0; frame < 50; ++frame) {
        draw_both();
        arrive();
    }
    draw(1);
    EXPECT_TRUE(screens->show());
    arrive();
}

TEST_F(Monitors, AreAskedAgainWhenTheDriverIsBusy) {
    open(kBoth);
    arrive();
    drm.committed.clear();
    drm.answers = {std::errc::device_or_resource_busy, std::errc::device_or_resource_busy};
    draw_both();
    EXPECT_TRUE(drm.committed.empty());
    EXPECT_TRUE(screens->busy());
    hear();
    EXPECT_TRUE(drm.committed.empty());
    hear();
    EXPECT_EQ(drm.committed.size(), 1u);
    arrive();
}

TEST_F(Monitors, ThatAreLostDoNotHoldTheOthers) {
    open(kBoth);
    arrive();
    news();
    draw_both();
    test::unplug(drm.card, "DP-2");
    drm.hot_plug = true;
    hear();
    EXPECT_THAT(news(), ElementsAre("right@DP-2: the monitor was unplugged"));
    EXPECT_EQ(screens->at(1).width(), 0);
    EXPECT_FALSE(drm.shown_at("DP-2"));
    EXPECT_EQ(surfaces.alive, 1);
    arrive();
    draw(0);
    EXPECT_TRUE(screens->show());
    arrive();
}

TEST_F(Monitors, ThatComeAgainAreShownTheirTiles) {
    open(kBoth);
    arrive();
    for (int round = 0; round < 5; ++round) {
        test::unplug(drm.card, "DP-2");
        drm.hot_plug = true;
        hear();
        test::plug(drm.card, "DP-2", "EIZO L985", {test::mode_of(1280, 1024, 60'020, true)});
        drm.hot_plug = true;
        hear();
        EXPECT_TRUE(screens->at(1).exposed());
        EXPECT_FALSE(drm.shown_at("DP-2")) << "until there is a picture";
        drm.committed.clear();
        draw_both();
        ASSERT_EQ(drm.committed.size(), 1u);
        EXPECT_EQ(drm.committed[0].kind, CommitKind::mode);
        EXPECT_TRUE(drm.shown_at("DP-2"));
        arrive();
    }
    EXPECT_EQ(drm.blobs.size(), 2u) << "no mode is left over";
    EXPECT_EQ(surfaces.alive, 2);
}

TEST_F(Monitors, MayBeOtherOnes) {
    open(kBoth);
    arrive();
    news();
    test::plug(drm.card, "DP-2", "LG", {test::mode_of(3840, 2160, 60'000, true)});
    drm.hot_plug = true;
    hear();
    EXPECT_EQ(screens->at(1).width(), 3840);
    draw(1);
    EXPECT_TRUE(screens->show());
    arrive();
    EXPECT_THAT(news(), ElementsAre("right@DP-2: another monitor was plugged in", "right@DP-2: 3840x2160@60 of LG"));
}

TEST_F(Monitors, WhoseLinkWasLostGetTheirModeAnew) {
    open(kBoth);
    arrive();
    test::connector(drm.card, "DP-1").link_bad = true;
    drm.hot_plug = true;
    hear();
    test::connector(drm.card, "DP-1").link_bad = false;
    EXPECT_TRUE(screens->at(0).exposed());
    drm.committed.clear();
    draw(0);
    EXPECT_TRUE(screens->show());
    ASSERT_EQ(drm.committed.size(), 1u);
    EXPECT_EQ(drm.committed[0].kind, CommitKind::mode);
    arrive();
}

TEST_F(Monitors, MayComeLater) {
    open(kThree);
    arrive();
    EXPECT_THAT(news(),
                ElementsAre("third@HDMI-A-1: no monitor at HDMI-A-1: connected are DP-1 (DELL U2720Q), DP-2 "
                            "(EIZO L985)",
                            "left@DP-1: 1920x1080@60 of DELL U2720Q", "right@DP-2: 1280x1024@60.02 of EIZO L985"));
    EXPECT_EQ(screens->at(2).width(), 0);
    test::plug(drm.card, "HDMI-A-1", "", {test::mode_of(800, 600)});
    drm.hot_plug = true;
    hear();
    EXPECT_EQ(screens->at(2).width(), 800);
    draw(2);
    EXPECT_TRUE(screens->show());
    arrive();
    EXPECT_TRUE(drm.shown_at("HDMI-A-1"));
}

/// A hub's connectors go with it, and come again with other numbers.
TEST_F(Monitors, MayHaveAnotherConnectorOfThatName) {
    open(kBoth);
    arrive();
    auto hub = test::connector(drm.card, "DP-2");
    std::erase_if(drm.card.connectors, [](const Connector& c) { return c.name == "DP-2"; });
    drm.hot_plug = true;
    hear();
    EXPECT_EQ(screens->at(1).width(), 0);
    hub.id = ConnectorId(177);
    drm.card.connectors.push_back(hub);
    drm.hot_plug = true;
    hear();
    draw(1);
    EXPECT_TRUE(screens->show());
    arrive();
    EXPECT_EQ(drm.value(177, "CRTC_ID"), 201u);
}

TEST_F(Monitors, WithoutTheModeThatIsWishedStayDarkWhenTheyComeLater) {
    open({{0, "left", "DP-1", {}}, {1, "third", "HDMI-A-1", ModeWish{1920, 1080, 0}}});
    arrive();
    news();
    test::plug(drm.card, "HDMI-A-1", "", {test::mode_of(800, 600)});
    drm.hot_plug = true;
    hear();
    EXPECT_THAT(news(), ElementsAre("third@HDMI-A-1: the monitor at HDMI-A-1 has no picture of 1920x1080: it has "
                                    "800x600@60"));
    EXPECT_EQ(screens->at(1).width(), 0);
}

TEST_F(Monitors, FlipOneByOneWhereTheDriverDoesNotFlipThemTogether) {
    drm.several = false;
    open(kBoth);
    arrive();
    news();
    drm.committed.clear();
    for (int frame = 0; frame < 3; ++frame) {
        draw_both();
        arrive();
    }
    EXPECT_EQ(drm.committed.size(), 6u);
    const auto told = screens->take_news();
    ASSERT_EQ(told.size(), 2u) << "once for each";
    EXPECT_EQ(told[0].note, "the driver does not flip several monitors together");
    EXPECT_EQ(told[0].mode, "1920x1080@60");
}

TEST_F(Monitors, ThatTheDriverDoesNotShowBesideTheOthersStayDark) {
    drm.most_signals = 2;
    open(kThree);
    arrive();
    news();
    test::plug(drm.card, "HDMI-A-1", "", {test::mode_of(800, 600)});
    drm.hot_plug = true;
    hear();
    draw(2);
    draw_both();
    EXPECT_THAT(news(), ElementsAre("third@HDMI-A-1: the driver refuses 800x600@60 beside the other monitors"));
    EXPECT_EQ(screens->at(2).width(), 0);
    arrive();
    draw_both();
    arrive();
}

TEST_F(Monitors, AreRefusedAltogetherWhereTheDriverCannotShowThem) {
    drm.most_signals = 1;
    EXPECT_THAT(refusal_of(kBoth),
                HasSubstr("/dev/dri/card0 refuses a picture of tile 'left' at 1920x1080@60 'right' at "
                          "1280x1024@60.02: Invalid argument"));
    EXPECT_EQ(surfaces.alive, 0);
    EXPECT_TRUE(drm.blobs.empty());
}

TEST_F(Monitors, OfSomebodyElseAreAnError) {
    open(kBoth);
    arrive();
    drm.answers = {std::errc::permission_denied};
    draw(0);
    const auto shown = screens->show();
    ASSERT_FALSE(shown);
    EXPECT_THAT(shown.error().message, HasSubstr("somebody else shows pictures on /dev/dri/card0: an X server"));
}

TEST_F(Monitors, AreOneAtLeast) {
    EXPECT_EQ(refusal_of({{0, "third", "HDMI-A-1", {}}}),
              "tile 'third': no monitor at HDMI-A-1: connected are DP-1 (DELL U2720Q), DP-2 (EIZO L985)");
    EXPECT_TRUE(drm.committed.empty()) << "nothing was changed";
}

TEST_F(Monitors, NeedPropertiesThatAnAtomicDriverHas) {
    drm.card.planes[0].properties.erase("SRC_W");
    EXPECT_EQ(refusal_of(kBoth), "/dev/dri/card0: plane 300 has no property SRC_W");
}

}  // namespace
}  // namespace wall::tileserver
