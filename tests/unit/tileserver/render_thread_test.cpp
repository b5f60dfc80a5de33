// SPDX-License-Identifier: MIT
// Several streams on the render thread: none keeps the driver from the others, whatever it sends.
#include "tileserver/render/render_thread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>

#include "common/glapi/program_format.h"
#include "common/wire/batch.h"
#include "gen/glapi/wire.gen.h"
#include "gen/glstate/state.gen.h"
#include "tests/unit/tileserver/monstrous_shader.h"
#include "tileserver/compile/compiler_host.h"
#include "tileserver/render/pace.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
namespace pack = glapi::pack;

// ---- the pace ----

/// That knows its commands: they cost a microsecond each, and the driver does at once what it is told.
Pace known_pace() {
    Pace pace;
    for (int i = 0; i < 8; ++i) {
        pace.spend(Pace::kAlone, 25'000, true);
        pace.finished(0ms, {});
    }
    return pace;
}

TEST(PaceTest, ATurnIsAsManyCommandsAsFitIntoItWithWhatTheDriverDoesForThem) {
    Pace pace = known_pace();
    EXPECT_EQ(pace.commands(true), 5000u);
    EXPECT_FALSE(pace.spend(2ms, 2000, true)) << "there is some left";
    EXPECT_EQ(pace.commands(true), 3000u);
    EXPECT_TRUE(pace.spend(3ms, 3000, true));
    pace.finished(15ms, {});  // the driver took three times as long
    EXPECT_EQ(pace.commands(true), 1250u);
    EXPECT_TRUE(pace.spend(1ms, 1250, true));
    pace.finished(0ms, {});
    EXPECT_EQ(pace.commands(true), 5000u) << "a step, though they cost less now";
}

TEST(PaceTest, ATurnEndsByTimeToo) {
    Pace pace = known_pace();
    EXPECT_TRUE(pace.spend(Pace::kTurn, 1, true)) << "one command may be the upload of a texture";
}

TEST(PaceTest, TurnsBeginSmallAndGrowBySteps) {
    Pace pace;
    EXPECT_EQ(pace.commands(true), 100u);
    EXPECT_EQ(pace.commands(false), 500u);
    EXPECT_TRUE(pace.spend(50us, 500, false));
    pace.finished(0ms, {});
    EXPECT_EQ(pace.commands(false), 2000u);
}

/// A driver that compiles spends a turn's time on a handful of commands: nothing follows for how many fit into one.
TEST(PaceTest, ALongTurnInWhichLittleIsToldLetsTurnsNotGrow) {
    Pace pace;
    for (int turn = 0; turn < 5; ++turn) {
        pace.spend(1ms, 10, false);
        pace.finished(0ms, {});
    }
    EXPECT_LE(pace.commands(false), 250u);
}

TEST(PaceTest, AloneItWaitsForTheDriverLessOften) {
    Pace pace = known_pace();
    EXPECT_EQ(pace.commands(false), 25'000u);
    EXPECT_FALSE(pace.spend(Pace::kAlone / 2, 12'500, false));
    EXPECT_TRUE(pace.spend(Pace::kAlone / 2, 12'500, false));
    pace.finished(99 * Pace::kAlone, {});
    EXPECT_EQ(pace.commands(false), 250u) << "much is behind little";
    EXPECT_TRUE(pace.spend(Pace::kAlone / 100, 250, false));
}

TEST(PaceTest, ADriverKeepsUpThatIsDoneSoonAfterItWasTold) {
    Pace pace;
    const auto turn = [&](Clock::duration spent, Clock::duration waited) {
        pace.spend(spent, 1000, false);
        pace.finished(waited, {});
    };
    EXPECT_FALSE(pace.driver_keeps_up()) << "nobody knows yet";
    turn(1ms, 0ms);
    EXPECT_FALSE(pace.driver_keeps_up()) << "it was not much";
    turn(10ms, 5ms);
    EXPECT_TRUE(pace.driver_keeps_up());
    turn(10ms, 100ms);
    EXPECT_FALSE(pace.driver_keeps_up());
}

TEST(PaceTest, ALongTurnIsMadeUpFor) {
    Pace pace;
    const Clock::time_point now{1h};
    EXPECT_TRUE(pace.may_run(now));
    EXPECT_TRUE(pace.spend(300ms, 1, true));
    pace.finished(0ms, now);
    EXPECT_FALSE(pace.may_run(now + 290ms));
    EXPECT_TRUE(pace.may_run(now + 295ms));
    pace.set_weight(10);
    pace.spend(300ms, 1, true);
    pace.finished(0ms, now);
    EXPECT_FALSE(pace.may_run(now + 29ms)) << "sooner by its weight";
    EXPECT_TRUE(pace.may_run(now + 30ms));
}

// ---- streams ----

class Events final : public NodeEvents {
public:
    void reply(StreamId stream, RequestId request, std::vector<std::byte> answer) override {
        note([&] { replies_[{stream, request}] = std::move(answer); });
    }
    void drawn(StreamId stream, SurfaceId, std::uint32_t frame) override {
        note([&] { drawn_[stream.value] = frame; });
    }
    void rendered(SessionId, SurfaceId, std::uint32_t) override {}
    void frames(SessionId, SurfaceId, std::uint32_t, std::uint32_t) override {}
    void failed(StreamId, SessionId, std::string reason) override {
        note([&] { failure_ = std::move(reason); });
    }
    void ended(StreamId, std::string reason) override {
        note([&] { failure_ = std::move(reason); });
    }
    void picture(Picture picture) override {
        note([&] { pictures_[picture.request.id.value] = std::move(picture.rgba); });
    }
    void partial(SessionId, NodeIndex, std::vector<std::byte>) override {}
    void tiles_taken(std::uint32_t) override {}
    void stats(const RenderStats&) override {
        note([&] { ++stats_; });
    }
    void scaled(const ScaledTile&) override {}
    void monitor(const MonitorNews&) override {}
    void output_lost(std::string reason) override {
        note([&] { lost_ = std::move(reason); });
    }

    /// Waits until `done(*this)`, with what it reads guarded; false: not in time.
    template <class Done>
    bool wait(Done&& done, Clock::duration limit = 60s) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, limit, [&] { return done(*this); });
    }
    std::map<std::uint32_t, std::uint32_t> drawn_;
    std::map<std::pair<StreamId, RequestId>, std::vector<std::byte>> replies_;
    std::map<std::uint32_t, std::vector<std::byte>> pictures_;
    std::string failure_, lost_;
    int stats_ = 0;

private:
    template <class Change>
    void note(Change&& change) {
        {
            const std::lock_guard lock(mutex_);
            change();
        }
        changed_.notify_all();
    }
    std::mutex mutex_;
    std::condition_variable changed_;
};

constexpr int kSize = 256;

template <class Draw>
void block(wire::PackBuffer& buffer, std::uint64_t tiles, Draw&& draw) {
    wire::PackBuffer body;
    draw(body);
    pack::Block(buffer, static_cast<std::uint32_t>(tiles), static_cast<std::uint32_t>(tiles >> 32),
                static_cast<std::uint32_t>(body.commands()), static_cast<std::uint32_t>(body.operand_bytes()));
    buffer.append(body, {}, body.mark());
}

class RenderThreadTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto compilers = CompilerHost::start("egl", {.processor_time = 2s, .time = 60s, .memory = 0});
        ASSERT_TRUE(compilers) << compilers.error().message;
        compilers_ = std::move(*compilers);
        auto thread = RenderThread::start("egl", events_, {}, compilers_.get());
        if (!thread) GTEST_SKIP() << thread.error().message;
        thread_ = std::move(*thread);
        thread_->set_tiles({{0, {0, 0, kSize, kSize}}}, 0);
    }
    std::shared_ptr<BatchQueue> open(std::uint32_t id) {
        auto queue = std::make_shared<BatchQueue>([] {});
        thread_->add_stream(StreamId(id), SessionId(id), queue);
        wire::PackBuffer buffer;
        create_window(buffer);
        push(queue, buffer);
        return queue;
    }
    static void create_window(wire::PackBuffer& buffer) {
        pack::SurfaceCreate(buffer, SurfaceId(1), 1, 0, 24, 8, 0, 0, 1, 0);
        pack::SurfacePlace(buffer, SurfaceId(1), 1, kSize, kSize, 0, 0, kSize, kSize, 0);
        pack::Bind(buffer, SurfaceId(1), SurfaceId(1));
        const glstate::Viewport viewport{0, 0, kSize, kSize};
        glapi::pack_state(buffer, glstate::el::viewport::id, &viewport, sizeof viewport);
    }
    void push(const std::shared_ptr<BatchQueue>& queue, const wire::PackBuffer& buffer) {
        RawBytes payload;
        wire::append_batch(payload, {ContextId(1), buffer.opcodes(), buffer.operands()});
        queue->push(std::move(payload));
        thread_->wake();
    }
    /// A program that draws a little for each frame, and starts one when the last is drawn: frames a second.
    double frames_a_second(std::uint32_t id, Clock::duration time) {
        const auto queue = open(id);
        const auto start = Clock::now();
        std::uint32_t frame = 0;
        while (Clock::now() - start < time) {
            wire::PackBuffer buffer;
            block(buffer, 1, [](auto& b) {
                pack::Clear(b, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
                pack::Begin(b, GL_TRIANGLES);
                for (int i = 0; i < 300; ++i)
                    pack::Vertex3f(b, static_cast<float>(i % 7) / 7, 0.1f * static_cast<float>(i % 3), 0);
                pack::End(b);
            });
            pack::Swap(buffer, SurfaceId(1), ++frame);
            push(queue, buffer);
            if (!events_.wait([&](Events& e) { return e.drawn_[id] == frame; })) break;
        }
        return frame / std::chrono::duration<double>(Clock::now() - start).count();
    }

    Events events_;  // outlives the thread
    std::unique_ptr<CompilerHost> compilers_;
    std::unique_ptr<RenderThread> thread_;
};

// ---- parallel programs ----

/// Two processes: the first clears, the second draws when that is done, both end the frame.
class AParallelProgram : public RenderThreadTest {
protected:
    static constexpr SessionId kSession{1};
    static constexpr std::uint32_t kBarrier = 1;

    void SetUp() override {
        RenderThreadTest::SetUp();
        if (!thread_) return;
        thread_->set_coordinated(true);
        thread_->set_stacking({{kSession, SurfaceId(1)}});
        for (const Rank rank : {0u, 1u}) {
            queues_[rank] = std::make_shared<BatchQueue>([] {});
            thread_->add_stream(StreamId(rank), kSession, queues_[rank], {2, {}}, rank);
            wire::PackBuffer join, window;
            pack::Join(join);
            push(queues_[rank], join);
            create_window(window);
            pack::BarrierCreate(window, kBarrier, 2);
            push(queues_[rank], window);
        }
    }
    void clear_and_swap(std::uint32_t frame) {
        wire::PackBuffer clear, swap;
        block(clear, 1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
        pack::BarrierExec(clear, kBarrier);
        push(queues_[0], clear);
        pack::Swap(swap, SurfaceId(1), frame);
        push(queues_[0], swap);
    }
    /// So much that the turn is over behind it.
    void draw_and_swap(int red, std::uint32_t frame) {
        wire::PackBuffer wait, buffer;
        pack::BarrierExec(wait, kBarrier);
        push(queues_[1], wait);
        block(buffer, 1, [&](auto& b) {
            pack::Color4f(b, static_cast<float>(red) / 255, 0, 0, 1);
            pack::Begin(b, GL_TRIANGLE_STRIP);  // each vertex makes a triangle that covers the window
            for (int i = 0; i < 160; ++i)
                for (const auto& [x, y] : {std::pair{-9.0f, -9.0f}, {9.0f, -9.0f}, {0.0f, 9.0f}})
                    pack::Vertex3f(b, x, y, 0);
            pack::End(b);
        });
        pack::Swap(buffer, SurfaceId(1), frame);
        push(queues_[1], buffer);
    }
    bool drawn(std::uint32_t frame) {
        return events_.wait([&](Events& e) { return e.drawn_[0] == frame && e.drawn_[1] == frame; });
    }
    /// The red of the tile's first pixel.
    int seen() {
        const PictureId id(++pictures_);
        thread_->request_picture({.id = id, .slot = 0});
        events_.wait([&](Events& e) { return e.pictures_.contains(id.value); });
        return std::to_integer<int>(events_.pictures_.at(id.value).at(0));
    }

    std::array<std::shared_ptr<BatchQueue>, 2> queues_;
    std::uint32_t pictures_ = 0;
};

/// Also where a turn ends behind a frame's last command, and the next frame begins with a clear.
TEST_F(AParallelProgram, ShowsEachFrameAsItWasWhenTheLastHadEndedIt) {
    clear_and_swap(1);
    for (std::uint32_t frame = 1; frame < 12; ++frame) {
        clear_and_swap(frame + 1);
        const int red = 100 + static_cast<int>(frame);
        draw_and_swap(red, frame);
        ASSERT_TRUE(drawn(frame));
        thread_->present(kSession, SurfaceId(1), frame);
        EXPECT_EQ(seen(), red);
    }
}

// ---- connections that end ----

/// A program of one colour, whose connection is closed.
class AConnectionThatIsClosed : public RenderThreadTest {
protected:
    static constexpr SessionId kSession{1};
    static constexpr StackEntry kWindow{kSession, SurfaceId(1)};

    void SetUp() override {
        RenderThreadTest::SetUp();
        if (!thread_) return;
        thread_->set_coordinated(true);
        thread_->set_stacking({kWindow});
        show(open_of_session(1), 1, 0.5f);
        ASSERT_EQ(seen(), 128);
    }
    std::shared_ptr<BatchQueue> open_of_session(std::uint32_t stream) {
        auto queue = std::make_shared<BatchQueue>([] {});
        thread_->add_stream(StreamId(stream), kSession, queue);
        wire::PackBuffer buffer;
        create_window(buffer);
        push(queue, buffer);
        return queue;
    }
    void show(const std::shared_ptr<BatchQueue>& queue, std::uint32_t frame, float red) {
        wire::PackBuffer buffer;
        const glstate::Vec4 colour{red, 0, 0, 1};
        glapi::pack_state(buffer, glstate::el::clear_color::id, &colour, sizeof colour);
        block(buffer, 1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
        pack::Swap(buffer, SurfaceId(1), frame);
        push(queue, buffer);
        EXPECT_TRUE(events_.wait([&](Events& e) {
            return std::ranges::any_of(e.drawn_, [&](const auto& drawn) { return drawn.second == frame; });
        }));
        thread_->present(kSession, SurfaceId(1), frame);
    }
    /// The red of the tile's first pixel.
    int seen() {
        const PictureId id(++pictures_);
        thread_->request_picture({.id = id, .slot = 0});
        int red = -1;
        events_.wait([&](Events& e) {
            const auto found = e.pictures_.find(id.value);
            if (found != e.pictures_.end()) red = std::to_integer<int>(found->second.at(0));
            return found != e.pictures_.end();
        });
        return red;
    }
    /// Whether that is seen before the time is over.
    bool becomes(int red, Clock::duration limit = 5s) {
        for (const auto end = Clock::now() + limit; Clock::now() < end; std::this_thread::sleep_for(20ms))
            if (seen() == red) return true;
        return false;
    }

    static constexpr auto kLongerThanWalldTakes = 1500ms;
    std::uint32_t pictures_ = 0;
};

TEST_F(AConnectionThatIsClosed, IsOutOfSightWhenWalldSaysThatItsProgramHasEnded) {
    thread_->remove_stream(StreamId(1));
    EXPECT_EQ(seen(), 128) << "nobody has said so yet";
    thread_->remove_session(kSession);
    EXPECT_EQ(seen(), 0);
}

TEST_F(AConnectionThatIsClosed, IsOutOfSightSoonIfWalldSaysNothing) {
    thread_->remove_stream(StreamId(1));
    EXPECT_TRUE(becomes(0));
}

TEST_F(AConnectionThatIsClosed, IsOutOfSightAtOnceWhileWalldIsAway) {
    thread_->set_coordinated(false);
    thread_->remove_stream(StreamId(1));
    EXPECT_TRUE(becomes(0, 500ms));
}

TEST_F(AConnectionThatIsClosed, StaysInSightWhileItsProgramIsAwaited) {
    thread_->remove_stream(StreamId(1));
    thread_->set_stacking({kWindow}, {}, {kSession});
    EXPECT_FALSE(becomes(0, kLongerThanWalldTakes));
    EXPECT_EQ(seen(), 128);
    thread_->set_stacking({}, {}, {});
    EXPECT_EQ(seen(), 0);
}

TEST_F(AConnectionThatIsClosed, StaysInSightUntilItsProgramShowsSomethingAgain) {
    thread_->remove_stream(StreamId(1));
    const auto again = open_of_session(2);
    EXPECT_FALSE(becomes(0, kLongerThanWalldTakes)) << "its program is held, or has much to send";
    EXPECT_EQ(seen(), 128);
    show(again, 2, 1.0f);
    EXPECT_TRUE(becomes(255));
    thread_->remove_stream(StreamId(2));
    EXPECT_TRUE(becomes(0)) << "nothing is left of the first one";
}

/// A list of small triangles.
void define_run(wire::PackBuffer& buffer, std::uint32_t run, int triangles, GLenum mode = GL_TRIANGLES) {
    wire::PackBuffer body;
    pack::Begin(body, mode);
    for (int i = 0; i < triangles; ++i) {
        const float x = static_cast<float>(i % 1000) / 500 - 1, y = static_cast<float>(i / 1000 % 1000) / 500 - 1;
        pack::Vertex3f(body, x, y, 0);
        pack::Vertex3f(body, x + 0.01f, y, 0);
        pack::Vertex3f(body, x, y + 0.01f, 0);
    }
    pack::End(body);
    std::vector<std::byte> content(wire::padded4(body.commands()) - body.commands());
    content.insert(content.end(), body.opcodes().begin(), body.opcodes().end());
    content.insert(content.end(), body.operands().begin(), body.operands().end());
    pack::RunDefine(buffer, ClientName(run), static_cast<std::uint32_t>(body.commands()),
                    static_cast<std::uint32_t>(body.operand_bytes()), content);
}

/// Frames a second beside a program that would take minutes for one; hundreds were measured on a busy machine.
constexpr double kDecent = 10;

TEST_F(RenderThreadTest, AShaderThatTakesTheCompilerMinutesIsRefusedAndKeepsNobodyAway) {
    const auto queue = open(1);
    wire::PackBuffer buffer;
    const std::string other_monster = test::monstrous_macros();
    glapi::ProgramDefinition monster, good;
    monster.shaders.push_back({.type = GL_FRAGMENT_SHADER, .compiled = true, .source = test::monstrous_shader()});
    good.shaders.push_back(
        {.type = GL_FRAGMENT_SHADER, .compiled = true, .source = "void main() { gl_FragColor = vec4(1); }"});
    pack::ProgramLink(buffer, RequestId(1), ClientName(1), encode(monster));
    pack::ShaderCompile(buffer, RequestId(2), GL_FRAGMENT_SHADER, std::as_bytes(std::span(other_monster)));
    pack::ProgramLink(buffer, RequestId(3), ClientName(1), encode(good));
    pack::Sync(buffer, RequestId(4));
    push(queue, buffer);
    EXPECT_GT(frames_a_second(2, 1s), kDecent) << "others draw meanwhile";
    const auto reply = [&](std::uint32_t id) { return std::pair{StreamId(1), RequestId(id)}; };
    EXPECT_FALSE(events_.wait([&](Events& e) { return e.replies_.contains(reply(1)); }, 0s)) << "still on trial";
    ASSERT_TRUE(events_.wait([&](Events& e) { return e.replies_.contains(reply(4)); }));
    const auto linked = glapi::decode_reflection(events_.replies_[reply(1)]);
    const auto compiled = glapi::decode_compile_result(events_.replies_[reply(2)]);
    const auto then = glapi::decode_reflection(events_.replies_[reply(3)]);
    ASSERT_TRUE(linked && compiled && then);
    EXPECT_FALSE(linked->linked);
    EXPECT_FALSE(compiled->compiled);
    for (const std::string& log : {linked->log, compiled->log})
        EXPECT_NE(log.find("2 s of processor time"), std::string::npos) << log;
    EXPECT_TRUE(then->linked) << then->log;
    EXPECT_EQ(events_.failure_, "");
}

TEST_F(RenderThreadTest, ABatchOfMinutesKeepsNobodyAway) {
    const auto heavy = open(1);
    wire::PackBuffer buffer;
    define_run(buffer, 7, 1'000'000);
    block(buffer, 1, [](auto& b) {
        for (int i = 0; i < 5000; ++i) pack::RunCall(b, ClientName(7));
    });
    push(heavy, buffer);
    std::this_thread::sleep_for(500ms);
    int stats_before = 0;
    events_.wait([&](Events& e) { return stats_before = e.stats_, true; });
    const double rate = frames_a_second(2, 4s);
    RecordProperty("frames_a_second", std::to_string(rate));
    std::printf("beside a list of a million triangles called 5000 times: %.1f frames a second\n", rate);
    EXPECT_GT(rate, kDecent);
    EXPECT_TRUE(events_.wait([&](Events& e) { return e.stats_ >= stats_before + 2; })) << "the watchdog is fed";
    EXPECT_EQ(events_.failure_, "");
}

/// Two programs that each want all there is, for as long as it takes.
TEST_F(RenderThreadTest, TurnsAreSharedByWeight) {
    constexpr std::uint32_t kHeavy = 1, kLight = 2, kFrames = 2000;
    for (const std::uint32_t id : {kHeavy, kLight}) {
        const auto queue = open(id);
        wire::PackBuffer list;
        define_run(list, 7, 20'000);
        push(queue, list);
        for (std::uint32_t frame = 1; frame <= kFrames; ++frame) {
            wire::PackBuffer buffer;
            block(buffer, 1, [](auto& b) { pack::RunCall(b, ClientName(7)); });
            pack::Swap(buffer, SurfaceId(1), frame);
            push(queue, buffer);
        }
    }
    const auto drawn_in = [&](Clock::duration time) {
        std::map<std::uint32_t, std::uint32_t> before, after;
        events_.wait([&](Events& e) { return before = e.drawn_, true; });
        std::this_thread::sleep_for(time);
        events_.wait([&](Events& e) { return after = e.drawn_, true; });
        EXPECT_LT(after[kHeavy], kFrames) << "it has had work all the time";
        return static_cast<double>(after[kHeavy] - before[kHeavy]) / std::max(1u, after[kLight] - before[kLight]);
    };
    thread_->set_quota(SessionId(kHeavy), {.weight = 4});
    std::this_thread::sleep_for(500ms);
    const double four = drawn_in(2s);
    thread_->set_quota(SessionId(kHeavy), {.weight = 0.25});
    std::this_thread::sleep_for(100ms);
    const double quarter = drawn_in(2s);
    std::printf("frames to one of the other at four times the weight: %.2f, at a quarter: %.2f\n", four, quarter);
    // 3.8 and 0.3 were measured; turns that a busy machine interrupts are too long to be shared as finely.
    EXPECT_GT(four, 1.5);
    EXPECT_LT(quarter, 1 / 1.5);
    EXPECT_EQ(events_.failure_, "");
}

TEST_F(RenderThreadTest, FramesAreNoMoreThanTheQuotaSays) {
    constexpr std::uint32_t kLimited = 1, kFrames = 400;
    thread_->set_quota(SessionId(kLimited), {.frame_interval = 20ms});
    const auto queue = open(kLimited);
    const auto begin = Clock::now();
    for (std::uint32_t frame = 1; frame <= kFrames; ++frame) {
        wire::PackBuffer buffer;
        pack::Swap(buffer, SurfaceId(1), frame);
        push(queue, buffer);
    }
    ASSERT_TRUE(events_.wait([&](Events& e) { return e.drawn_[kLimited] >= 51; }));
    EXPECT_GT(Clock::now() - begin, 950ms);
    thread_->set_quota(SessionId(kLimited), {});
    ASSERT_TRUE(events_.wait([&](Events& e) { return e.drawn_[kLimited] == kFrames; }));
    EXPECT_LT(Clock::now() - begin, 6s) << "8 s with the limit";
    EXPECT_EQ(events_.failure_, "");
}

/// Little to tell the driver, much for it to do: it gathers triangles and fills them later.
TEST_F(RenderThreadTest, ABatchOfLargeTrianglesKeepsNobodyAway) {
    const auto heavy = open(1);
    wire::PackBuffer buffer;
    const glstate::Flag on = 1;
    glapi::pack_state(buffer, glstate::el::blend_enabled::id, &on, sizeof on);
    block(buffer, 1, [](auto& b) {
        for (int i = 0; i < 400'000; ++i) {
            pack::Begin(b, GL_TRIANGLES);
            pack::Vertex2f(b, -1, -1);
            pack::Vertex2f(b, 3, -1);
            pack::Vertex2f(b, -1, 3);
            pack::End(b);
        }
    });
    push(heavy, buffer);
    std::this_thread::sleep_for(500ms);
    const double rate = frames_a_second(2, 4s);
    std::printf("beside 400,000 triangles over the whole window: %.1f frames a second\n", rate);
    EXPECT_GT(rate, kDecent);
    EXPECT_EQ(events_.failure_, "");
}

TEST_F(RenderThreadTest, SelectionKeepsNobodyAway) {
    const auto picking = open(1);
    wire::PackBuffer buffer;
    pack::RenderMode(buffer, RequestId(1), GL_SELECT, 0, 1000);
    block(buffer, std::uint64_t{1} << wire::kOffscreenSlot, [](auto& b) {
        pack::PushName(b, 5);
        for (int i = 0; i < 200'000; ++i) {
            pack::Begin(b, GL_TRIANGLES);
            for (int corner = 0; corner < 30; ++corner)
                pack::Vertex2f(b, static_cast<float>(corner % 2), static_cast<float>(corner % 3));
            pack::End(b);
        }
    });
    push(picking, buffer);
    const double while_it_draws = frames_a_second(2, 3s);
    std::printf("beside a program in selection mode: %.1f frames a second\n", while_it_draws);
    EXPECT_GT(while_it_draws, kDecent);
    wire::PackBuffer end;
    pack::RenderMode(end, RequestId(2), GL_RENDER, 0, 0);
    push(picking, end);
    ASSERT_TRUE(events_.wait([](Events& e) {
        return e.replies_.contains({StreamId(1), RequestId(2)});
    })) << events_.failure_;
    std::vector<GLuint> answer(events_.replies_[{StreamId(1), RequestId(2)}].size() / sizeof(GLuint));
    std::memcpy(answer.data(), events_.replies_[{StreamId(1), RequestId(2)}].data(), answer.size() * sizeof(GLuint));
    ASSERT_EQ(answer.size(), 5u) << "one hit, in however many parts";
    EXPECT_EQ(answer[0], 1u);
    EXPECT_EQ(answer[1], 1u);
    EXPECT_EQ(answer[4], 5u);
}

TEST_F(RenderThreadTest, ASelectionLeftOpenKeepsNobodyAway) {
    const auto picking = open(1);
    wire::PackBuffer buffer;
    pack::RenderMode(buffer, RequestId(1), GL_SELECT, 0, 1000);
    push(picking, buffer);
    ASSERT_TRUE(events_.wait([](Events& e) { return e.replies_.contains({StreamId(1), RequestId(1)}); }));
    const auto start = Clock::now();
    frames_a_second(2, 1ms);
    EXPECT_LT(Clock::now() - start, 2s);
    EXPECT_EQ(events_.failure_, "");
}

// ---- a driver that is reset ----

std::atomic<GLenum> reset_status = GL_NO_ERROR;
GLenum GLAPIENTRY said_status() { return reset_status; }

class ResettableBackend final : public GlBackend {
public:
    explicit ResettableBackend(std::unique_ptr<GlBackend> real) : real_(std::move(real)) {}
    Result<void> make_current() override { return real_->make_current(); }
    void* get_proc_address(const char* name) const override {
        if (std::string_view(name) == "glGetGraphicsResetStatus") return reinterpret_cast<void*>(&said_status);
        return real_->get_proc_address(name);
    }
    std::string_view name() const override { return real_->name(); }

private:
    std::unique_ptr<GlBackend> real_;
};

TEST(DriverReset, EndsTheNodeWithAReason) {
    Events events;
    reset_status = GL_NO_ERROR;
    const auto open = []() -> Result<std::unique_ptr<GlBackend>> {
        auto real = open_egl_backend();
        if (!real) return tl::unexpected(real.error());
        return std::make_unique<ResettableBackend>(std::move(*real));
    };
    auto thread = RenderThread::start(open, "egl", events);
    if (!thread) GTEST_SKIP() << thread.error().message;
    ASSERT_TRUE(events.wait([](Events& e) { return e.stats_ > 0; }));
    EXPECT_EQ(events.lost_, "");
    reset_status = GL_GUILTY_CONTEXT_RESET;
    EXPECT_TRUE(events.wait([](Events& e) { return !e.lost_.empty(); }));
    EXPECT_THAT(events.lost_, ::testing::HasSubstr("reset"));
}

}  // namespace
}  // namespace wall::tileserver
