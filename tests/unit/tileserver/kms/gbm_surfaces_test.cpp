// SPDX-License-Identifier: MIT
// libdrm, GBM and EGL as they are, on a card that is nothing but memory (fake_kernel.h).
#include "tileserver/kms/gbm_surfaces.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <optional>
#include <utility>

#include "tests/unit/tileserver/kms/fake_kernel.h"
#include "tileserver/gpu/gl.h"
#include "tileserver/kms/kms_screens.h"
#include "tileserver/kms/libdrm_device.h"

namespace wall::tileserver {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::uint32_t kOrange = 0xff8000;

class RealLibraries : public ::testing::Test {
protected:
    static void SetUpTestSuite() { ::setenv("GBM_ALWAYS_SOFTWARE", "1", 1); }

    Result<std::unique_ptr<LibdrmDevice>> open() { return LibdrmDevice::open(kernel.path()); }

    test::FakeDrm drm{test::two_monitors()};
    test::FakeKernel kernel{drm};
};

TEST_F(RealLibraries, DescribeACardAsItIs) {
    const auto device = open();
    ASSERT_TRUE(device) << device.error().message;
    const auto card = (*device)->describe();
    ASSERT_TRUE(card) << card.error().message;
    EXPECT_EQ(card->name, kernel.path());
    ASSERT_EQ(card->connectors.size(), 3u);
    const Connector& first = card->connectors[0];
    EXPECT_EQ(text_of(first), "DP-1 (DELL U2720Q)");
    EXPECT_TRUE(first.connected);
    EXPECT_FALSE(first.link_bad);
    EXPECT_THAT(first.crtcs, ElementsAre(CrtcId(200)));
    ASSERT_EQ(first.modes.size(), 3u);
    EXPECT_EQ(text_of(first.modes[0]), "1920x1080@60");
    EXPECT_TRUE(first.modes[0].preferred);
    EXPECT_EQ(text_of(first.modes[1]), "1920x1080@74.97");
    EXPECT_EQ(text_of(card->connectors[2]), "HDMI-A-1");
    EXPECT_FALSE(card->connectors[2].connected);
    ASSERT_EQ(card->crtcs.size(), 3u);
    EXPECT_TRUE(card->crtcs[1].properties.contains("MODE_ID"));
    ASSERT_EQ(card->planes.size(), 3u);
    EXPECT_TRUE(card->planes[2].primary && card->planes[2].plain);
    EXPECT_THAT(card->planes[2].crtcs, ElementsAre(CrtcId(202)));
    EXPECT_EQ(card->planes[0].properties.at("SRC_W").id, test::id_of("SRC_W"));
}

TEST_F(RealLibraries, SayWhatADriverLacks) {
    kernel.atomic = false;
    const auto device = open();
    ASSERT_FALSE(device);
    EXPECT_THAT(device.error().message, HasSubstr("fake has no atomic mode setting: expected output = \"window\""));
    const auto missing = LibdrmDevice::open("/dev/dri/card99");
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("/dev/dri/card99 cannot be opened: No such file or directory"));
}

TEST_F(RealLibraries, SayThatACardIsSomebodyElses) {
    kernel.nobody_is_master = false;
    const auto device = open();
    ASSERT_TRUE(device) << device.error().message;
    const auto master = (*device)->become_master();
    ASSERT_FALSE(master);
    EXPECT_THAT(master.error().message, HasSubstr("somebody else shows pictures on " + kernel.path()));
}

/// The kernel's events of plugs cannot be made up; all else is the device's.
class Plugged final : public DrmDevice {
public:
    explicit Plugged(DrmDevice& device) : device_(device) {}
    const std::string& name() const override { return device_.name(); }
    Result<Card> describe() override { return device_.describe(); }
    Result<BlobId> make_blob(std::span<const std::byte> bytes) override { return device_.make_blob(bytes); }
    void free_blob(BlobId blob) override { device_.free_blob(blob); }
    Result<FramebufferId> add_framebuffer(const BufferLayout& layout) override {
        return device_.add_framebuffer(layout);
    }
    void remove_framebuffer(FramebufferId framebuffer) override { device_.remove_framebuffer(framebuffer); }
    [[nodiscard]] std::errc commit(const AtomicRequest& request, CommitKind kind) override {
        return device_.commit(request, kind);
    }
    Result<std::vector<CrtcId>> take_flips() override { return device_.take_flips(); }
    bool take_hot_plug() override { return std::exchange(hot_plug, false); }

    bool hot_plug = false;

private:
    DrmDevice& device_;
};

/// Draws to buffers that monitors show, and looks into the card's memory.
class RealPictures : public RealLibraries {
protected:
    void SetUp() override {
        auto opened = open();
        ASSERT_TRUE(opened) << opened.error().message;
        device = std::move(*opened);
        plugged.emplace(*device);
        auto made = GbmSurfaces::open(*plugged, device->descriptor());
        if (!made) GTEST_SKIP() << "no GBM here: " << made.error().message;
        surfaces = std::move(*made);
        auto shown = KmsScreens::open(
            *plugged, *surfaces,
            std::vector<MonitorWish>{{0, "left", "DP-1", ModeWish{640, 480, 0}}, {1, "right", "DP-2", {}}}, kOrange);
        ASSERT_TRUE(shown) << shown.error().message;
        screens = std::move(*shown);
        gl.load([](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); });
    }
    void TearDown() override {
        screens.reset();
        surfaces.reset();
        EXPECT_EQ(drm.framebuffers.size(), 0u);
        EXPECT_EQ(kernel.buffers(), 0u) << "nothing of the card's memory is left over";
    }
    void hear() {
        const auto heard = screens->take_events();
        EXPECT_TRUE(heard) << heard.error().message;
    }
    void arrive() {
        kernel.beat();
        hear();
        EXPECT_FALSE(screens->busy());
    }
    void fill(std::size_t i, float red, float green, float blue) {
        ASSERT_TRUE(screens->select(i));
        gl.ClearColor(red, green, blue, 1);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        const auto swapped = screens->swap(i);
        ASSERT_TRUE(swapped) << swapped.error().message;
    }

    std::unique_ptr<LibdrmDevice> device;
    std::optional<Plugged> plugged;
    std::unique_ptr<GbmSurfaces> surfaces;
    std::unique_ptr<KmsScreens> screens;
    Gl gl;
};

TEST_F(RealPictures, AreTheBackgroundFirst) {
    EXPECT_EQ(kernel.pixel_at("DP-1", 0, 0), kOrange);
    EXPECT_EQ(kernel.pixel_at("DP-1", 639, 479), kOrange);
    EXPECT_EQ(kernel.pixel_at("DP-2", 1279, 1023), kOrange);
    arrive();
}

TEST_F(RealPictures, AreWhatWasDrawn) {
    arrive();
    for (int frame = 0; frame < 10; ++frame) {
        const bool odd = frame % 2 != 0;
        fill(0, odd ? 1 : 0, 0, 1);
        fill(1, 0, odd ? 1 : 0, 0);
        ASSERT_TRUE(screens->show());
        EXPECT_EQ(kernel.pixel_at("DP-1", 320, 240), odd ? 0xff00ffu : 0x0000ffu);
        EXPECT_EQ(kernel.pixel_at("DP-2", 640, 512), odd ? 0x00ff00u : 0x000000u);
        arrive();
    }
    EXPECT_LE(kernel.buffers(), 6u) << "three each";
}

/// The buffers of a monitor that goes do so while the context is current with them.
TEST_F(RealPictures, AreForOtherMonitorsToo) {
    arrive();
    for (const auto& [width, height] : {std::pair(1024, 768), std::pair(800, 600)}) {
        fill(1, 1, 1, 0);
        ASSERT_TRUE(screens->show());
        test::unplug(drm.card, "DP-2");
        plugged->hot_plug = true;
        hear();
        EXPECT_FALSE(drm.shown_at("DP-2"));
        EXPECT_LE(kernel.buffers(), 3u) << "of the other monitor";
        test::plug(drm.card, "DP-2", "LG", {test::mode_of(width, height)});
        plugged->hot_plug = true;
        hear();
        ASSERT_EQ(screens->at(1).width(), width);
        fill(1, 0, 1, 1);
        fill(0, 1, 1, 1);
        ASSERT_TRUE(screens->show());
        EXPECT_EQ(kernel.pixel_at("DP-2", static_cast<std::uint32_t>(width) - 1, 0), 0x00ffffu);
        EXPECT_EQ(kernel.pixel_at("DP-1", 0, 0), 0xffffffu);
        arrive();
    }
}

/// A window's first row is its lowest one, a monitor's its highest.
TEST_F(RealPictures, AreUpright) {
    arrive();
    ASSERT_TRUE(screens->select(0));
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(0, 479, 640, 1);
    gl.ClearColor(1, 1, 1, 1);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.Disable(GL_SCISSOR_TEST);
    ASSERT_TRUE(screens->swap(0));
    ASSERT_TRUE(screens->show());
    EXPECT_EQ(kernel.pixel_at("DP-1", 320, 0), 0xffffffu);
    arrive();
}

}  // namespace
}  // namespace wall::tileserver
