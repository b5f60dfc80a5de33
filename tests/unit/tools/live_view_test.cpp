// SPDX-License-Identifier: MIT
#include "tools/view/live_view.h"

#include <gtest/gtest.h>

#include <atomic>
#include <deque>

namespace wall::view {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr auto kSoon = 10s;

/// What the feeds of a test do; they may outlive nothing but their view.
struct Script {
    std::atomic<int> opened = 0, open = 0;
    std::atomic<bool> refuse = false, broken = false;
    std::mutex mutex;
    json last_entry;
};

class ScriptedFeed : public Feed {
public:
    explicit ScriptedFeed(Script& script) : script_(script) { ++script_.opened, ++script_.open; }
    ~ScriptedFeed() override { --script_.open; }
    Result<std::optional<FeedMessage>> next(std::chrono::milliseconds) override {
        if (script_.broken) return fail("the stream ended");
        if (!std::exchange(told_, true))
            return FeedMessage{
                false,
                R"({"stream": 0, "codec": "raw", "width": 2, "height": 1, "background": "#000000", "parts": []})"};
        std::this_thread::sleep_for(1ms);
        return std::nullopt;
    }

private:
    Script& script_;
    bool told_ = false;
};

class LiveViewTest : public ::testing::Test {
protected:
    LiveView::Connect connect() {
        return [this](const json& entry) -> Outcome<std::unique_ptr<Feed>> {
            const std::lock_guard lock(script_.mutex);
            script_.last_entry = entry;
            if (script_.refuse) return tl::unexpected<Failure>({"unavailable", "walld is not there"});
            return std::make_unique<ScriptedFeed>(script_);
        };
    }
    static bool until(const std::function<bool()>& done) {
        const auto end = std::chrono::steady_clock::now() + kSoon;
        while (!done() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(1ms);
        return done();
    }
    static std::string failure(const LiveView& view) {
        std::string out;
        view.look([&](const Looked& now) { out = now.failure; });
        return out;
    }
    Script script_;
};

TEST_F(LiveViewTest, ConnectsAgainAndSaysWhy) {
    script_.refuse = true;
    LiveView view(connect(), {{"wall", true}}, LiveView::AfterFailure::connect_again);
    EXPECT_TRUE(view.wait_complete(kSoon));
    EXPECT_EQ(failure(view), "walld is not there");
    script_.refuse = false;
    EXPECT_TRUE(until([&] { return failure(view).empty(); }));
    EXPECT_EQ(script_.open, 1);
    script_.broken = true;
    EXPECT_TRUE(until([&] { return failure(view) == "the stream ended"; }));
    script_.broken = false;
    EXPECT_TRUE(until([&] { return failure(view).empty() && script_.open == 1; }));
}

TEST_F(LiveViewTest, AFailureStaysWhereThatIsWanted) {
    script_.broken = true;
    LiveView view(connect(), {{"wall", true}}, LiveView::AfterFailure::stay);
    EXPECT_TRUE(view.wait_complete(kSoon));
    EXPECT_EQ(failure(view), "the stream ended");
    EXPECT_EQ(script_.opened, 1);
}

TEST_F(LiveViewTest, APausedOneHasNoConnection) {
    LiveView view(connect(), {{"wall", true}}, LiveView::AfterFailure::connect_again);
    EXPECT_TRUE(view.wait_complete(kSoon));
    view.pause(true);
    EXPECT_TRUE(until([&] { return script_.open == 0; }));
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(script_.opened, 1);
    view.pause(false);
    EXPECT_TRUE(until([&] { return script_.open == 1; }));
}

TEST_F(LiveViewTest, WatchesSomethingElseWhenTold) {
    LiveView view(connect(), {{"wall", true}}, LiveView::AfterFailure::connect_again);
    EXPECT_TRUE(view.wait_complete(kSoon));
    view.watch({{"tile", "left"}});
    EXPECT_TRUE(until([&] { return script_.opened == 2; }));
    const std::lock_guard lock(script_.mutex);
    EXPECT_EQ(script_.last_entry, (json{{"tile", "left"}}));
}

}  // namespace
}  // namespace wall::view
