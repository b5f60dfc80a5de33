// SPDX-License-Identifier: MIT
#include "tileserver/kms/screen_plan.h"

#include <gmock/gmock.h>

#include "tests/unit/tileserver/kms/fake_drm.h"
#include "tileserver/kms/pairing.h"

namespace wall::tileserver {
namespace {

using test::mode_of;
using ::testing::ElementsAre;

std::string refusal_of(const Card& card, const std::vector<MonitorWish>& wishes) {
    const auto plans = plan_screens(card, wishes);
    EXPECT_FALSE(plans);
    return plans ? "" : plans.error().message;
}

std::vector<std::string> connectors_of(const Card& card, const std::vector<MonitorWish>& wishes) {
    const auto plans = plan_screens(card, wishes);
    EXPECT_TRUE(plans) << plans.error().message;
    std::vector<std::string> out;
    for (std::size_t i = 0; plans && i < plans->size(); ++i) out.push_back((*plans)[i].connector.name);
    return out;
}

MonitorWish wish(const std::string& tile, const std::string& connector = {}, std::optional<ModeWish> mode = {}) {
    return {0, tile, connector, mode};
}

TEST(ScreenPlan, HasTheConnectorsThatAreNamed) {
    const auto card = test::two_monitors();
    EXPECT_THAT(connectors_of(card, {wish("a", "DP-2"), wish("b", "DP-1")}), ElementsAre("DP-2", "DP-1"));
    EXPECT_THAT(connectors_of(card, {wish("a", "HDMI-A-1"), wish("b", "DP-1")}), ElementsAre("HDMI-A-1", "DP-1"))
        << "one may come later";
}

TEST(ScreenPlan, HasTheNextMonitorWhereNoneIsNamed) {
    auto card = test::two_monitors();
    EXPECT_THAT(connectors_of(card, {wish("a"), wish("b")}), ElementsAre("DP-1", "DP-2"));
    EXPECT_THAT(connectors_of(card, {wish("a"), wish("b", "DP-1")}), ElementsAre("DP-2", "DP-1"));
    test::connector(card, "DP-1").desktop = false;
    EXPECT_THAT(connectors_of(card, {wish("a")}), ElementsAre("DP-2")) << "a headset is no monitor";
    EXPECT_THAT(connectors_of(card, {wish("a", "DP-1")}), ElementsAre("DP-1")) << "unless somebody says so";
}

TEST(ScreenPlan, SaysWhatThereIsInstead) {
    const auto card = test::two_monitors();
    EXPECT_EQ(refusal_of(card, {wish("a", "DP-9")}),
              "tile 'a': /dev/dri/card0 has no connector DP-9: it has DP-1 (DELL U2720Q), DP-2 (EIZO L985), HDMI-A-1 "
              "without a monitor");
    EXPECT_EQ(refusal_of(card, {wish("a"), wish("b"), wish("c")}),
              "tile 'c': no monitor is left for it: connected are DP-1 (DELL U2720Q), DP-2 (EIZO L985)");
    EXPECT_EQ(refusal_of(card, {wish("a", "HDMI-A-1")}),
              "tile 'a': no monitor at HDMI-A-1: connected are DP-1 (DELL U2720Q), DP-2 (EIZO L985)");
    EXPECT_EQ(refusal_of(Card{"/dev/dri/card1", {}, {}, {}}, {wish("a")}),
              "tile 'a': no monitor is left for it: nothing is connected to /dev/dri/card1");
    EXPECT_EQ(refusal_of(card, {wish("a", "DP-2", ModeWish{1920, 1080, 60'000})}),
              "tile 'a': the monitor at DP-2 (EIZO L985) has no picture of 1920x1080 at 60 Hz: it has 1280x1024@60.02");
}

/// Some connectors go with all CRTCs, some with the first only.
TEST(ScreenPlan, FindsCrtcsForAllWhereThereAreSome) {
    auto card = test::two_monitors();
    card.connectors[0].crtcs = {CrtcId(200), CrtcId(201)};
    card.connectors[1].crtcs = {CrtcId(200)};
    const auto plans = plan_screens(card, std::vector{wish("a", "DP-1"), wish("b", "DP-2")});
    ASSERT_TRUE(plans) << plans.error().message;
    EXPECT_EQ((*plans)[0].crtc.id, CrtcId(201));
    EXPECT_EQ((*plans)[0].plane.id, PlaneId(301));
    EXPECT_EQ((*plans)[1].crtc.id, CrtcId(200));
    card.connectors[0].crtcs = {CrtcId(200)};
    EXPECT_EQ(
        refusal_of(card, {wish("a", "DP-1"), wish("b", "DP-2")}),
        "/dev/dri/card0 cannot show pictures at all of these at once: DP-1, DP-2; it makes 3 signals, and not each "
        "of them for each connector");
}

TEST(ScreenPlan, LeavesAConnectorTheCrtcThatItHas) {
    auto card = test::two_monitors();
    for (auto& connector : card.connectors) connector.crtcs = {CrtcId(200), CrtcId(201), CrtcId(202)};
    card.connectors[0].properties["CRTC_ID"].value = 202;
    const auto plans = plan_screens(card, std::vector{wish("a"), wish("b")});
    ASSERT_TRUE(plans);
    EXPECT_EQ((*plans)[0].crtc.id, CrtcId(202));
    EXPECT_EQ((*plans)[1].crtc.id, CrtcId(200));
}

TEST(ScreenPlan, NeedsAPrimaryPlaneThatTakesOurPixels) {
    auto card = test::two_monitors();
    card.planes[0].plain = false;
    card.planes.push_back({PlaneId(399), false, true, {CrtcId(200)}, {}});
    EXPECT_EQ(refusal_of(card, {wish("a")}),
              "/dev/dri/card0 has no primary plane for pixels of 8 bits a channel (XRGB8888) for each of 1 monitors");
}

Connector with_modes(std::vector<Mode> modes) {
    Connector out{ConnectorId(1), "DP-1", true};
    out.modes = std::move(modes);
    return out;
}

std::string chosen(const Connector& connector, std::optional<ModeWish> wanted = {}) {
    const auto mode = choose_mode(connector, wanted);
    return mode ? text_of(*mode) : mode.error().message;
}

TEST(ModeChoice, IsTheMonitorsFavourite) {
    EXPECT_EQ(chosen(with_modes({mode_of(640, 480), mode_of(1920, 1080, 60'000, true)})), "1920x1080@60");
    EXPECT_EQ(chosen(with_modes({mode_of(800, 600), mode_of(640, 480, 120'000)})), "800x600@60") << "else its first";
    EXPECT_EQ(chosen(with_modes({})),
              "the monitor at DP-1 has no picture that is not interlaced: it says nothing of any");
    EXPECT_EQ(chosen(Connector{ConnectorId(1), "DP-1"}), "no monitor at DP-1");
}

TEST(ModeChoice, IsWhatWasAskedFor) {
    const auto monitor =
        with_modes({mode_of(1920, 1080, 60'000), mode_of(1920, 1080, 59'940), mode_of(1920, 1080, 143'981),
                    mode_of(1280, 720, 60'000, true), mode_of(1280, 720, 120'000)});
    EXPECT_EQ(chosen(monitor, ModeWish{1920, 1080, 0}), "1920x1080@143.98") << "the fastest";
    EXPECT_EQ(chosen(monitor, ModeWish{1280, 720, 0}), "1280x720@60") << "but for the favourite";
    EXPECT_EQ(chosen(monitor, ModeWish{1920, 1080, 60'000}), "1920x1080@60");
    EXPECT_EQ(chosen(monitor, ModeWish{1920, 1080, 59'940}), "1920x1080@59.94");
    EXPECT_EQ(chosen(monitor, ModeWish{1920, 1080, 144'000}), "1920x1080@143.98");
    EXPECT_EQ(chosen(monitor, ModeWish{1920, 1080, 100'000}),
              "the monitor at DP-1 has no picture of 1920x1080 at 100 Hz: it has 1920x1080@60, 1920x1080@59.94, "
              "1920x1080@143.98, 1280x720@60, 1280x720@120");
}

TEST(ModeChoice, IsNeverInterlaced) {
    auto interlaced = mode_of(1920, 1080, 60'000, true);
    interlaced.interlaced = true;
    EXPECT_EQ(chosen(with_modes({interlaced, mode_of(1280, 720)})), "1280x720@60");
}

TEST(Pairing, FindsAWayIfThereIsOne) {
    using Candidates = std::vector<std::vector<std::size_t>>;
    EXPECT_EQ(pair_up(Candidates{}, 3), std::vector<std::size_t>{});
    EXPECT_EQ(pair_up(Candidates{{2, 0}, {0}}, 3), (std::vector<std::size_t>{2, 0}));
    EXPECT_EQ(pair_up(Candidates{{0, 1}, {0}, {1, 2}}, 3), (std::vector<std::size_t>{1, 0, 2}));
    EXPECT_EQ(pair_up(Candidates{{0}, {0}}, 3), std::nullopt);
    EXPECT_EQ(pair_up(Candidates{{}}, 3), std::nullopt);
}

}  // namespace
}  // namespace wall::tileserver
