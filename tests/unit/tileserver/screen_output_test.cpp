// SPDX-License-Identifier: MIT
#include "tileserver/render/screen_output.h"

#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <vector>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr geom::Rect kTile{0, 0, 8, 4};

class FakeScreen final : public TileScreen {
public:
    FakeScreen(std::uint32_t slot, std::int32_t width) : TileScreen(slot, "tile " + std::to_string(slot)) {
        resize(width, 4);
    }
    using TileScreen::expose;
};

/// Notes what is called.
class FakeScreens final : public TileScreens {
public:
    std::size_t count() const override { return screens.size(); }
    FakeScreen& at(std::size_t i) const override { return *screens[i]; }
    std::chrono::nanoseconds refresh_period() const override { return 16ms; }
    Result<void> take_events() override { return error.empty() ? Result<void>() : fail(error); }
    bool busy() const override { return is_busy; }
    Result<void> select(std::size_t i) override { return note("select", i); }
    Result<void> swap(std::size_t i) override { return note("swap", i); }
    Result<void> show() override {
        calls.push_back("show");
        return {};
    }
    std::vector<MonitorNews> take_news() override { return std::exchange(news, {}); }

    Result<void> note(const std::string& call, std::size_t i) {
        calls.push_back(call + " " + std::to_string(i));
        return {};
    }
    std::vector<std::string> take_calls() { return std::exchange(calls, {}); }

    std::vector<std::unique_ptr<FakeScreen>> screens;
    std::vector<std::string> calls;
    std::vector<MonitorNews> news;
    std::string error;
    bool is_busy = false;
};

class Output : public ::testing::Test {
protected:
    void SetUp() override {
        if (!test_node.usable()) GTEST_SKIP() << "no EGL here";
        test_node.node->tiles = {{0, kTile}, {1, kTile}};
        compositor.emplace(*test_node.node, [](const StackEntry&) { return nullptr; });
        for (std::uint32_t slot = 0; slot < 2; ++slot)
            screens.screens.push_back(std::make_unique<FakeScreen>(slot, kTile.width));
        output.emplace(*test_node.node, *compositor, screens,
                       ScreenOutput::Events{[this](const ScaledTile& tile) { scaled.push_back(tile.tile); },
                                            [this](const MonitorNews& news) { told.push_back(news.note); }});
    }
    void TearDown() override { compositor.reset(); }
    std::vector<std::string> show() {
        const auto shown = output->show(now);
        EXPECT_TRUE(shown) << shown.error().message;
        return screens.take_calls();
    }

    test::TestNode test_node;
    std::optional<Compositor> compositor;
    FakeScreens screens;
    std::optional<ScreenOutput> output;
    std::vector<std::string> scaled, told;
    ScreenOutput::Clock::time_point now{1h};
};

TEST_F(Output, DrawsAllScreensAndThenShowsThem) {
    EXPECT_THAT(show(), ElementsAre("select 0", "swap 0", "select 1", "swap 1", "show"));
    now += 1s;
    EXPECT_THAT(show(), IsEmpty()) << "nothing has changed";
    screens.at(1).expose();
    EXPECT_THAT(show(), ElementsAre("select 1", "swap 1", "show"));
}

TEST_F(Output, IsNotFasterThanTheMonitors) {
    show();
    ++test_node.node->damage;
    EXPECT_EQ(output->next_due(now), 14ms);
    now += 13ms;
    EXPECT_THAT(show(), IsEmpty());
    now += 1ms;
    EXPECT_FALSE(show().empty());
}

TEST_F(Output, WaitsForPicturesThatAreOnTheirWay) {
    show();
    now += 1s;
    EXPECT_EQ(output->next_due(now), ScreenOutput::Clock::duration::max());
    screens.is_busy = true;
    EXPECT_EQ(output->next_due(now), 1ms);
    ++test_node.node->damage;
    EXPECT_THAT(show(), IsEmpty());
    screens.is_busy = false;
    EXPECT_EQ(output->next_due(now), 0ms);
    EXPECT_FALSE(show().empty());
}

TEST_F(Output, LeavesOutAMonitorThatIsGone) {
    screens.screens[0] = std::make_unique<FakeScreen>(0, 0);
    EXPECT_THAT(show(), ElementsAre("select 1", "swap 1", "show"));
}

TEST_F(Output, TellsOnceThatATileIsScaled) {
    screens.screens[1] = std::make_unique<FakeScreen>(1, 16);
    show();
    ++test_node.node->damage;
    now += 1s;
    show();
    EXPECT_THAT(scaled, ElementsAre("tile 1"));
}

TEST_F(Output, TellsOfMonitorsAlsoWhenNothingCanBeShownAnyMore) {
    screens.news.push_back({"tile 0", "DP-1", "", "", "unplugged"});
    screens.error = "gone";
    const auto shown = output->show(now);
    ASSERT_FALSE(shown);
    EXPECT_EQ(shown.error().message, "gone");
    EXPECT_THAT(told, ElementsAre("unplugged"));
}

}  // namespace
}  // namespace wall::tileserver
