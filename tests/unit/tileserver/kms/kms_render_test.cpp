// SPDX-License-Identifier: MIT
// A node's render thread with tiles on monitors of a card that is nothing but memory (fake_kernel.h).
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "tests/unit/tileserver/kms/fake_kernel.h"
#include "tileserver/kms/kms_backend.h"
#include "tileserver/render/render_thread.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kBefore = 0x402010, kOrange = 0xff8000, kBlue = 0x0000ff;
constexpr auto kLimit = 20s;

class Events final : public NodeEvents {
public:
    void reply(StreamId, RequestId, std::vector<std::byte>) override {}
    void drawn(StreamId, SurfaceId, std::uint32_t) override {}
    void rendered(SessionId, SurfaceId, std::uint32_t) override {}
    void frames(SessionId, SurfaceId, std::uint32_t, std::uint32_t) override {}
    void failed(StreamId, SessionId, std::string) override {}
    void ended(StreamId, std::string) override {}
    void picture(Picture) override {}
    void partial(SessionId, NodeIndex, std::vector<std::byte>) override {}
    void tiles_taken(std::uint32_t) override {}
    void stats(const RenderStats&) override {}
    void scaled(const ScaledTile&) override { ++scaled_tiles; }
    void monitor(const MonitorNews&) override { ++monitors; }
    void output_lost(std::string reason) override {
        const std::lock_guard lock(mutex_);
        lost_ = std::move(reason);
    }
    std::string lost() const {
        const std::lock_guard lock(mutex_);
        return lost_;
    }
    std::atomic<int> scaled_tiles = 0, monitors = 0;

private:
    mutable std::mutex mutex_;
    std::string lost_;
};

class Node : public ::testing::Test {
protected:
    void SetUp() override {
        ::setenv("GBM_ALWAYS_SOFTWARE", "1", 1);
        const auto open = [this]() -> Result<std::unique_ptr<GlBackend>> {
            auto card = LibdrmDevice::open(kernel.path());
            if (!card) return tl::unexpected(card.error());
            return open_kms_backend(std::move(*card),
                                    {.background = kBefore,
                                     .wishes = {{0, "left", "DP-1", ModeWish{640, 480, 0}}, {1, "right", "DP-2", {}}}});
        };
        auto started = RenderThread::start(open, "egl", events);
        ASSERT_TRUE(started) << started.error().message;
        thread = std::move(*started);
    }
    /// What both monitors show in the end, as they beat; the last thing seen if it is not that.
    void expect_both(std::uint32_t colour) {
        const auto shows = [&] {
            return kernel.pixel_at("DP-1", 320, 240) == colour && kernel.pixel_at("DP-2", 640, 512) == colour;
        };
        for (const auto end = std::chrono::steady_clock::now() + kLimit;
             !shows() && std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(2ms))
            kernel.beat();
        EXPECT_EQ(kernel.pixel_at("DP-1", 320, 240), colour);
        EXPECT_EQ(kernel.pixel_at("DP-2", 640, 512), colour);
    }

    test::FakeDrm drm{test::two_monitors()};
    test::FakeKernel kernel{drm};
    Events events;
    std::unique_ptr<RenderThread> thread;
};

TEST_F(Node, ShowsItsTilesOnMonitors) {
    expect_both(kBefore);
    const std::vector<Tile> tiles{{0, {0, 0, 640, 480}}, {1, {640, 0, 1920, 1080}}};
    thread->set_tiles(tiles, kOrange);
    thread->set_stacking({});
    expect_both(kOrange);
    thread->set_tiles(tiles, kBlue);
    thread->set_stacking({});
    expect_both(kBlue);
    EXPECT_EQ(events.monitors, 2);
    EXPECT_EQ(events.scaled_tiles, 1) << "the right monitor has 1280x1024";
    EXPECT_EQ(events.lost(), "");
    thread.reset();
    EXPECT_EQ(kernel.buffers(), 0u);
}

}  // namespace
}  // namespace wall::tileserver
