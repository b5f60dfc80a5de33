// SPDX-License-Identifier: MIT
// A program's connections to its nodes, with a walld and nodes that the test plays. A process has one session, so the
// tests are one story in order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <span>
#include <thread>

#include "client_lib/context/core.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/link/reopening.h"
#include "common/glapi/gl_types.h"
#include "gen/glapi/wire.gen.h"
#include "proto/control.pb.h"
#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {
namespace {

constexpr std::uint32_t kSilentNodes = 4;

/// walld: answers one client until it hangs up.
class FakeWalld {
public:
    explicit FakeWalld(const std::vector<std::string>& nodes) : nodes_(nodes), listener_("session_walld") {}
    ~FakeWalld() {
        stop_ = true;
        thread_.join();
    }
    std::string address() const { return listener_.address(); }

private:
    void serve() {
        const UniqueFd link = listener_.accept();
        while (!stop_) {
            std::uint32_t size = 0;
            if (!readable(link.get(), 50ms)) continue;
            if (::recv(link.get(), &size, sizeof size, MSG_WAITALL) != sizeof size) return;
            std::string bytes(size, '\0');
            ::recv(link.get(), bytes.data(), size, MSG_WAITALL);
            proto::Envelope envelope;
            if (envelope.ParseFromString(bytes)) answer(link.get(), envelope);
        }
    }
    void answer(int fd, const proto::Envelope& message) {
        proto::Envelope envelope;
        if (message.has_client_hello()) {
            welcome(*envelope.mutable_client_welcome());
        } else if (message.has_surface_open()) {
            auto& placement = *envelope.mutable_placement();
            placement.set_surface(message.surface_open().surface());
            placement.set_layout_version(1);
            placement.mutable_rect()->set_width(100);
            placement.mutable_rect()->set_height(100);
        } else if (message.has_surface_adopted()) {
            envelope.mutable_adoption_noted()->set_surface(message.surface_adopted().surface());
            envelope.mutable_adoption_noted()->set_layout_version(message.surface_adopted().layout_version());
        } else if (message.has_ping()) {
            envelope.mutable_pong();
        } else {
            return;
        }
        const auto bytes = envelope.SerializeAsString();
        const auto size = static_cast<std::uint32_t>(bytes.size());
        ::send(fd, &size, sizeof size, MSG_NOSIGNAL);
        ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
    void welcome(proto::ClientWelcome& welcome) const {
        welcome.set_session(1);
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            auto* tile = welcome.add_tiles();
            tile->set_node(i);
            tile->mutable_rect()->set_width(100);
            tile->mutable_rect()->set_height(100);
            auto* node = welcome.add_nodes();
            node->set_node(i);
            node->set_address(nodes_[i]);
            node->set_ticket("ticket");
        }
    }

    const std::vector<std::string> nodes_;
    Listener listener_;
    std::atomic<bool> stop_{false};
    std::thread thread_{[this] { serve(); }};
};

class ASession : public testing::Test {
protected:
    static void SetUpTestSuite() {
        std::vector<std::string> addresses;
        for (std::uint32_t i = 0; i < kSilentNodes; ++i) {
            silent.push_back(std::make_unique<Listener>("session_silent" + std::to_string(i) + "_"));
            addresses.push_back(silent.back()->address());
        }
        node = std::make_unique<FakeNode>("session_node");
        addresses.push_back(node->listener.address());
        walld = std::make_unique<FakeWalld>(addresses);
        ::setenv("WALLGL_WALLD", walld->address().c_str(), 1);
    }
    static void TearDownTestSuite() {
        make_current(nullptr, nullptr, nullptr);
        context.reset();
        surface.reset();
        walld.reset();
        silent.clear();
        node.reset();
    }
    /// Without a back buffer a frame ends with glFlush.
    static void draw() {
        reinterpret_cast<void (*)(GLbitfield)>(gl_proc_address("glClear"))(GL_COLOR_BUFFER_BIT);
        flush_current(false);
    }

    static inline std::vector<std::unique_ptr<Listener>> silent;
    static inline std::unique_ptr<FakeNode> node;
    static inline std::unique_ptr<FakeWalld> walld;
    static inline std::shared_ptr<Context> context;
    static inline std::shared_ptr<ClientSurface> surface;
};

TEST_F(ASession, StartsInOneLimitHoweverManyNodesAreSilent) {
    SurfaceOptions options;
    options.format.double_buffered = false;
    options.size = {100, 100};
    surface = create_surface(options);
    context = create_context({});
    std::thread node_side([] { EXPECT_TRUE(node->welcome([] {})); });
    const auto start = Clock::now();
    ASSERT_TRUE(make_current(context, surface, surface));
    const auto took = Clock::now() - start;
    node_side.join();
    EXPECT_LT(took, 4s) << "each silent node is waited for up to 2 s";
    draw();
    EXPECT_TRUE(node->receives(glapi::Op::SurfaceCreate)) << "the node that answers is drawn on";
}

TEST_F(ASession, OpensABrokenStreamAgainAndTellsTheNodeEverything) {
    for (int time = 0; time < 2; ++time) {
        node->stream.reset();
        ASSERT_TRUE(node->welcome(draw)) << "time " << time;
        for (const auto end = Clock::now() + kPatience; !readable(node->stream.get(), 20ms) && Clock::now() < end;)
            draw();
        EXPECT_TRUE(node->receives(glapi::Op::SurfaceCreate)) << "time " << time << ": the node holds nothing";
    }
}

TEST_F(ASession, LeavesANodeAloneThatEndsItAgainAndAgain) {
    testing::internal::CaptureStderr();
    unsigned opened = 1;
    for (;; ++opened) {
        node->send(FrameKind::error, "no such thing");
        node->stream.reset();
        if (opened > Reopening::kMostEndings || !node->welcome(draw, 8s)) break;
    }
    EXPECT_EQ(opened, Reopening::kMostEndings);
    draw();
    EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("no such thing"));
}

// ---- its nodes alone ----

/// Some that are silent, and behind them one that answers; what a member of a parallel program is told of them.
class NodesOfAWall : public testing::Test {
protected:
    NodesOfAWall() {
        for (std::uint32_t i = 0; i < kSilentNodes; ++i) {
            silent_.push_back(std::make_unique<Listener>("nodes_silent" + std::to_string(i) + "_"));
            infos_.push_back({NodeIndex(i), silent_.back()->address(), "ticket", 1, true});
        }
        infos_.push_back({NodeIndex(kSilentNodes), fake_.listener.address(), "ticket", 1, true});
    }
    std::vector<std::unique_ptr<Listener>> silent_;
    FakeNode fake_{"nodes_node"};
    std::vector<NodeInfo> infos_;
    Nodes nodes_{{[](Node&) {}, [] {}, [] {}, [] {}}};
};

TEST_F(NodesOfAWall, AreWaitedForInOneLimitHoweverManyAreSilent) {
    std::thread node_side([this] { EXPECT_TRUE(fake_.welcome([] {})); });
    const auto start = Clock::now();
    nodes_.connect_and_wait(infos_);
    const auto took = Clock::now() - start;
    node_side.join();
    EXPECT_LT(took, 4s) << "each silent node is waited for up to 2 s";
    EXPECT_FALSE(nodes_[NodeIndex(0)].alive());
    EXPECT_TRUE(nodes_[NodeIndex(kSilentNodes)].alive());
    nodes_.connect_and_wait(std::span(infos_).last(1));
    EXPECT_TRUE(nodes_[NodeIndex(kSilentNodes)].alive()) << "it stays connected to that process";
}

TEST_F(NodesOfAWall, AreWaitedForWithoutTheLock) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    nodes_.connect(infos_.front());
    std::atomic<bool> drew{false};
    std::thread other([&] {
        const std::lock_guard held(mutex);
        drew = true;
    });
    nodes_.wait_for_attempts(lock, 1500ms);
    EXPECT_TRUE(lock.owns_lock());
    EXPECT_TRUE(drew) << "other threads go on beside a node that is silent";
    lock.unlock();
    other.join();
}

TEST_F(NodesOfAWall, ThatRecordAreToldAnewWhenTheyAskAndNeverAsked) {
    NodeInfo recorder = infos_.back();
    recorder.records = true;
    std::thread node_side([this] { EXPECT_TRUE(fake_.welcome([] {})); });
    nodes_.connect_and_wait(std::span(&recorder, 1));
    node_side.join();
    Node& node = nodes_[recorder.node];
    ASSERT_TRUE(node.alive());
    EXPECT_FALSE(node.answers());
    const auto know_something = [&node] {
        node.mirrors[ContextId(1)];
        node.object_stamps[ClientName(1)] = 5;
        node.surfaces[SurfaceId(1)] = 1;
    };
    know_something();
    nodes_.begin_recordings_again();
    EXPECT_EQ(node.surfaces.size(), 1u) << "it has not asked";
    fake_.send(FrameKind::begin_again, "");
    for (const auto end = Clock::now() + kPatience; !node.surfaces.empty() && Clock::now() < end;)
        nodes_.begin_recordings_again();
    EXPECT_TRUE(node.mirrors.empty() && node.object_stamps.empty() && node.surfaces.empty());
    EXPECT_TRUE(fake_.receives(glapi::Op::BeginAgain));
    know_something();
    nodes_.begin_recordings_again();
    EXPECT_EQ(node.surfaces.size(), 1u) << "once for each time that it asks";
}

// ---- the policy alone ----

TEST(Reopening, TriesABrokenStreamAtOnceAndThenEverMoreRarely) {
    Reopening reopening;
    Reopening::Time now{};
    reopening.opened(now);
    reopening.lost(now += 5s, false);
    EXPECT_TRUE(reopening.due(now));
    for (const auto pause : {1s, 2s, 4s, 8s, 16s, 30s, 30s, 30s}) {
        reopening.not_opened(now);
        EXPECT_FALSE(reopening.due(now + pause - 1ms)) << pause.count();
        EXPECT_TRUE(reopening.due(now += pause)) << pause.count();
    }
    EXPECT_FALSE(reopening.given_up());
    reopening.opened(now);
    reopening.lost(now += Reopening::kProven, false);
    EXPECT_TRUE(reopening.due(now)) << "it had lasted";
}

TEST(Reopening, LeavesANodeAloneThatEndsTheStreamForACause) {
    Reopening reopening;
    Reopening::Time now{};
    for (unsigned i = 0; i < Reopening::kMostEndings; ++i) {
        EXPECT_FALSE(reopening.given_up());
        reopening.opened(now);
        reopening.lost(now += 1s, true);
        EXPECT_FALSE(reopening.due(now)) << "never at once";
        now += Reopening::kLongestPause;
    }
    EXPECT_TRUE(reopening.given_up());
    EXPECT_FALSE(reopening.due(now + 1h));
}

TEST(Reopening, EndingsFarApartAreNoReasonToGiveUp) {
    Reopening reopening;
    Reopening::Time now{};
    for (unsigned i = 0; i < 10 * Reopening::kMostEndings; ++i) {
        reopening.opened(now);
        reopening.lost(now += Reopening::kProven, true);
        EXPECT_FALSE(reopening.given_up());
    }
}

}  // namespace
}  // namespace wall::client
