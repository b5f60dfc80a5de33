// SPDX-License-Identifier: MIT
#include "tileserver/kms/cards.h"

#include <gmock/gmock.h>

#include "tests/unit/tileserver/kms/fake_drm.h"
#include "tileserver/kms/kms_backend.h"
#include "tileserver/kms/uevents.h"

namespace wall::tileserver {
namespace {

using namespace std::string_view_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<CardFile> kTwo{{"/dev/dri/card0", "0000:17:00.0"}, {"/dev/dri/card1", ""}}, kNone;

std::string refusal_of(const std::vector<CardFile>& cards, std::string_view gpu) {
    const auto chosen = choose_cards(cards, gpu);
    EXPECT_FALSE(chosen);
    return chosen ? "" : chosen.error().message;
}

TEST(CardChoice, IsAllOrThatOfAnAddress) {
    EXPECT_THAT(*choose_cards(kTwo, "auto"), ElementsAre("/dev/dri/card0", "/dev/dri/card1"));
    EXPECT_THAT(*choose_cards(kTwo, "0000:17:00.0"), ElementsAre("/dev/dri/card0"));
    EXPECT_THAT(*choose_cards(kTwo, "17:00.0"), ElementsAre("/dev/dri/card0"));
}

TEST(CardChoice, SaysWhichThereAre) {
    EXPECT_EQ(refusal_of(kTwo, "65:00.0"),
              "there is no graphics card '65:00.0': there are /dev/dri/card0 (0000:17:00.0), /dev/dri/card1");
    EXPECT_THAT(refusal_of(kNone, "auto"), HasSubstr("this machine has no graphics card for monitors"));
}

TEST(Cards, AreListedWithTheirMonitors) {
    EXPECT_EQ(monitor_lines(kTwo[0], test::two_monitors()),
              "/dev/dri/card0  0000:17:00.0\n"
              "  DP-1         DELL U2720Q     1920x1080@60* 1920x1080@74.97 640x480@60\n"
              "  DP-2         EIZO L985       1280x1024@60.02*\n"
              "  HDMI-A-1     -\n");
    EXPECT_FALSE(monitor_table().empty());
}

TEST(Cards, AreMissingWithOneSentence) {
    if (!card_files().empty()) GTEST_SKIP() << "this machine has graphics cards, which a test leaves alone";
    const auto backend = open_kms_backend({.wishes = {{0, "a", "DP-1", {}}}});
    ASSERT_FALSE(backend);
    EXPECT_THAT(backend.error().message, HasSubstr("this machine has no graphics card for monitors"));
}

constexpr auto kPlugged =
    "change@/devices/pci0000:00/0000:00:02.0/drm/card0\0ACTION=change\0SUBSYSTEM=drm\0HOTPLUG=1\0DEVNAME=dri/card0\0"
    "DEVTYPE=drm_minor\0SEQNUM=3120\0"sv;

TEST(HotPlug, IsAnEventOfTheCardsMonitors) {
    EXPECT_TRUE(is_hot_plug(kPlugged, "dri/card0"));
    EXPECT_FALSE(is_hot_plug(kPlugged, "dri/card1"));
    EXPECT_FALSE(is_hot_plug("change@/x\0SUBSYSTEM=drm\0DEVNAME=dri/card0\0"sv, "dri/card0")) << "something else of it";
    EXPECT_FALSE(is_hot_plug("add@/x\0SUBSYSTEM=usb\0HOTPLUG=1\0"sv, "dri/card0"));
}

TEST(HotPlug, IsNotReadBeyondAMessagesEnd) {
    EXPECT_FALSE(is_hot_plug("", "dri/card0"));
    const auto needed = kPlugged.find("HOTPLUG=1") + "HOTPLUG=1"sv.size();
    for (std::size_t size = 0; size < needed; ++size) EXPECT_FALSE(is_hot_plug(kPlugged.substr(0, size), "dri/card0"));
    EXPECT_TRUE(is_hot_plug(kPlugged.substr(0, needed), "dri/card0")) << "without a zero byte at its end";
}

TEST(HotPlug, IsHeardWithoutWaiting) {
    auto uevents = Uevents::open("dri/card0");
    if (!uevents) GTEST_SKIP() << uevents.error().message;
    uevents->take();
}

}  // namespace
}  // namespace wall::tileserver
