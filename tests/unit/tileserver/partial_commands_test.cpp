// SPDX-License-Identifier: MIT
// What two nodes draw of a window, put together on a third one, beside what one node draws of all of it.
#include <gmock/gmock.h>

#include <array>
#include <cstring>

#include "common/wire/whole_window.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/partials/partial_box.h"

namespace wall::tileserver::test {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 120;
constexpr geom::Rect kLeft{0, 0, 67, kHeight}, kRight{67, 0, 93, kHeight};
constexpr SurfaceId kSurface{1};
/// Both receivers.
constexpr std::uint64_t kPartial = std::uint64_t{1} << wire::kPartialSlot | 3;
constexpr std::uint32_t kRenderers[] = {4, 5};

/// A triangle that leans through the picture. Its colour is multiplied by its alpha.
void pack_triangle(wire::PackBuffer& b, int which, float alpha) {
    constexpr std::array<std::array<float, 3>, 4> kColors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}}};
    const auto& [red, green, blue] = kColors[static_cast<std::size_t>(which)];
    const float turn = 0.4f * static_cast<float>(which);
    pack::Color4f(b, alpha * red, alpha * green, alpha * blue, alpha);
    pack::Begin(b, GL_TRIANGLES);
    pack::Vertex3f(b, -0.9f + turn, -0.8f, -0.9f);
    pack::Vertex3f(b, 0.9f, -0.7f + turn, 0.9f - turn);
    pack::Vertex3f(b, -0.3f, 0.9f - turn, turn - 0.5f);
    pack::End(b);
}

struct Receiver {
    std::uint32_t node, slot;
    std::int32_t x, y, width, height;
};
constexpr Receiver kReceivers[] = {{9, 0, 0, 0, 67, kHeight}, {9, 1, 67, 0, 93, kHeight}};

class PartialPicturesOfNodes : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kLeft}, {1, kRight}};
        node_.node->partials = &box_;
    }
    static void open(TestSession& session, std::uint32_t kind) {
        Batch batch;
        pack::SurfaceCreate(batch.buffer(), kSurface, 1, 0, 24, 0, 0, 0, 0, 0);
        pack::SurfacePlace(batch.buffer(), kSurface, 1, kWidth, kHeight, 0, 0, kWidth, kHeight, kind);
        pack::Bind(batch.buffer(), kSurface, kSurface);
        batch.set<el::viewport>({0, 0, kWidth, kHeight}).set<el::scissor>({0, 0, kWidth, kHeight});
        batch.set<el::depth_test>(1);
        session.expect_run(batch);
    }
    static void clear(TestSession& session) {
        Batch batch;
        batch.set<el::clear_color>({0.2f, 0.2f, 0.2f, 0}).block(3, [](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        });
        session.expect_run(batch);
    }
    static void draw(TestSession& session, std::uint64_t slots, int which, bool marks, bool blends = false) {
        Batch batch;
        if (blends)
            batch.set<el::depth_test>(0).set<el::blend_enabled>(1).set<el::blend_func>(
                {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA});
        if (marks)
            for (unsigned face = 0; face < 2; ++face)
                batch.set<el::stencil_func>({GL_ALWAYS, 1, 0xff}, face)
                    .set<el::stencil_op>({GL_KEEP, GL_KEEP, GL_REPLACE}, face);
        batch.set<el::stencil_test>(marks ? 1 : 0).block(slots, [&](auto& b) {
            pack_triangle(b, which, blends ? 0.6f : 1);
        });
        session.expect_run(batch);
    }
    /// Draws two of the triangles for others, and sends them.
    void deal(TestSession& renderer, std::uint32_t from, int first, std::uint32_t sequence = 1, GLenum by = GL_LESS) {
        Batch begin;
        pack::PartialBegin(begin.buffer(), kSurface, by, std::as_bytes(std::span(kReceivers)));
        renderer.expect_run(begin);
        for (const int which : {first, first + 1}) draw(renderer, kPartial, which, true, by == GL_BLEND);
        Batch send;
        pack::PartialSend(send.buffer(), kSurface, sequence, from, RequestId(5));
        renderer.expect_run(send);
        EXPECT_EQ(renderer.replies[RequestId(5)].size(), sizeof(std::uint64_t)) << "how long it took";
    }
    void deliver(TestSession& renderer) {
        for (auto& [to, message] : renderer.partials) {
            EXPECT_EQ(to, NodeIndex(9));
            const auto put = box_.put(SessionId(1), std::move(message));
            EXPECT_TRUE(put) << put.error().message;
        }
        renderer.partials.clear();
    }
    static Batch merging(std::span<const std::uint32_t> nodes, std::uint32_t sequence = 1, GLenum func = GL_LESS) {
        Batch batch;
        pack::PartialMerge(batch.buffer(), kSurface, sequence, func, 3, 0, std::as_bytes(nodes));
        return batch;
    }
    /// How many pixels of both tiles differ.
    static std::size_t differ(TestSession& a, TestSession& b) {
        return count_different(a.read(0, kLeft), b.read(0, kLeft)) +
               count_different(a.read(1, kRight), b.read(1, kRight));
    }
    /// How far apart bytes of them are at most.
    static int apart(const std::vector<Pixels>& a, const std::vector<Pixels>& b) {
        int most = 0;
        for (std::size_t tile = 0; tile < a.size(); ++tile)
            for (std::size_t i = 0; i < a[tile].size(); ++i) most = std::max(most, std::abs(a[tile][i] - b[tile][i]));
        return most;
    }
    /// Both tiles' back buffers.
    static std::vector<Pixels> read(TestSession& session) { return {session.read(0, kLeft), session.read(1, kRight)}; }

    TestNode node_;
    PartialBox box_;
};

TEST_F(PartialPicturesOfNodes, AreThePictureThatOneWouldHaveDrawn) {
    TestSession shows(*node_.node, SessionId(1)), alone(*node_.node, SessionId(2)), first(*node_.node, SessionId(3)),
        second(*node_.node, SessionId(4));
    for (TestSession* session : {&shows, &alone}) {
        open(*session, wire::kTilesOnly);
        clear(*session);
    }
    for (TestSession* session : {&first, &second}) open(*session, wire::kTilesOnly);
    for (int which = 0; which < 4; ++which) draw(alone, 3, which, false);
    deal(first, kRenderers[0], 0);
    deal(second, kRenderers[1], 2);
    deliver(first);
    deliver(second);
    shows.expect_run(merging(kRenderers));
    EXPECT_EQ(differ(shows, alone), 0u);
    EXPECT_EQ(shows.session.work.partials_merged, 4u);
    EXPECT_EQ(shows.session.work.partials_missed, 0u);
    // What is drawn behind it meets its depths.
    for (TestSession* session : {&shows, &alone}) draw(*session, 3, 1, false);
    EXPECT_EQ(differ(shows, alone), 0u);
}

TEST_F(PartialPicturesOfNodes, ThatBlendLieOneOverTheOther) {
    TestSession shows(*node_.node, SessionId(1)), alone(*node_.node, SessionId(2)), first(*node_.node, SessionId(3)),
        second(*node_.node, SessionId(4));
    for (TestSession* session : {&shows, &alone, &first, &second}) open(*session, wire::kTilesOnly);
    for (int which = 0; which < 4; ++which) {
        if (which == 0) clear(alone);
        draw(alone, 3, which, false, true);
    }
    const auto merged = [&](std::uint32_t sequence, const std::array<std::uint32_t, 2>& order) {
        clear(shows);
        deal(first, kRenderers[0], 0, sequence, GL_BLEND);
        deal(second, kRenderers[1], 2, sequence, GL_BLEND);
        deliver(first);
        deliver(second);
        shows.expect_run(merging(order, sequence, GL_BLEND));
        return read(shows);
    };
    EXPECT_LE(apart(merged(1, {4, 5}), read(alone)), 2) << "each part is rounded by itself";
    EXPECT_GT(apart(merged(2, {5, 4}), read(alone)), 50) << "the order matters";
    EXPECT_EQ(shows.session.work.partials_missed, 0u);
}

TEST_F(PartialPicturesOfNodes, GoOverWhatTheTilesHold) {
    TestSession shows(*node_.node, SessionId(1)), alone(*node_.node, SessionId(2)), first(*node_.node, SessionId(3));
    for (TestSession* session : {&shows, &alone}) {
        open(*session, wire::kTilesOnly);
        clear(*session);
        draw(*session, 3, 3, false);
    }
    open(first, wire::kTilesOnly);
    for (const int which : {0, 1}) draw(alone, 3, which, false);
    deal(first, kRenderers[0], 0);
    deliver(first);
    shows.expect_run(merging(std::span(kRenderers).first(1)));
    EXPECT_EQ(differ(shows, alone), 0u);
}

TEST_F(PartialPicturesOfNodes, AreWaitedFor) {
    TestSession shows(*node_.node, SessionId(1)), first(*node_.node, SessionId(3));
    open(shows, wire::kTilesOnly);
    open(first, wire::kTilesOnly);
    clear(shows);
    const auto before = read(shows);
    const Batch batch = merging(std::span(kRenderers).first(1));
    const auto payload = batch.payload();
    ASSERT_TRUE(shows.executor.start_batch(payload));
    EXPECT_FALSE(shows.executor.run_slice({}).value());
    EXPECT_TRUE(shows.executor.waits());
    deal(first, kRenderers[0], 0);
    deliver(first);
    EXPECT_FALSE(shows.executor.waits());
    EXPECT_TRUE(shows.executor.run_slice({}).value());
    EXPECT_NE(read(shows), before);
}

TEST_F(PartialPicturesOfNodes, ThatDoNotComeAreDoneWithout) {
    TestSession shows(*node_.node, SessionId(1));
    open(shows, wire::kTilesOnly);
    clear(shows);
    const auto before = read(shows);
    const auto payload = merging(kRenderers).payload();
    ASSERT_TRUE(shows.executor.start_batch(payload));
    while (!shows.executor.run_slice({}).value()) {
    }
    EXPECT_EQ(read(shows), before);
    EXPECT_EQ(shows.session.work.partials_missed, 4u);
}

TEST_F(PartialPicturesOfNodes, OfTheNodeItselfTakeNoWay) {
    TestSession shows(*node_.node, SessionId(1));
    open(shows, wire::kTilesOnly);
    clear(shows);
    const auto before = read(shows);
    deal(shows, 9, 0);
    EXPECT_TRUE(shows.partials.empty());
    constexpr std::uint32_t kOwn[] = {9};
    shows.expect_run(merging(kOwn));
    EXPECT_NE(read(shows), before);
}

TEST_F(PartialPicturesOfNodes, OfWhatIsNotThereEndTheStream) {
    const auto refused = [&](auto&& pack_it) {
        TestSession session(*node_.node, SessionId(1));
        open(session, wire::kTilesOnly);
        Batch batch;
        pack_it(batch.buffer());
        const auto done = session.run(batch);
        return done ? std::string() : done.error().message;
    };
    constexpr Receiver kOutside[] = {{9, 0, 1, 0, kWidth, kHeight}}, kNoSlot[] = {{9, 64, 0, 0, 1, 1}};
    EXPECT_THAT(refused([](auto& b) { pack::PartialBegin(b, SurfaceId(7), GL_LESS, {}); }),
                HasSubstr("does not exist"));
    EXPECT_THAT(refused([](auto& b) { pack::PartialBegin(b, kSurface, GL_EQUAL, {}); }), HasSubstr("nothing merges"));
    EXPECT_THAT(refused([&](auto& b) { pack::PartialBegin(b, kSurface, GL_LESS, std::as_bytes(std::span(kOutside))); }),
                HasSubstr("not in the window"));
    EXPECT_THAT(refused([&](auto& b) { pack::PartialBegin(b, kSurface, GL_LESS, std::as_bytes(std::span(kNoSlot))); }),
                HasSubstr("not in the window"));
    EXPECT_THAT(refused([](auto& b) { pack::PartialMerge(b, kSurface, 1, GL_ALWAYS, 1, 0, {}); }),
                HasSubstr("by nothing"));
}

}  // namespace
}  // namespace wall::tileserver::test
