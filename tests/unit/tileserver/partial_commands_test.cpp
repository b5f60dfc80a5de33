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

/// Of the layers of those two, each in two parts, for nodes 6 and 7 to compose.
struct Band {
    std::uint32_t layer, node, name;
    std::int32_t x, y, width, height;
};
constexpr std::uint32_t kCompositors[] = {6, 7};
constexpr Band kBands[] = {{0, 6, 64, 0, 0, 67, 50},
                           {0, 7, 65, 0, 50, 67, kHeight - 50},
                           {1, 6, 66, 67, 0, 93, 50},
                           {1, 7, 67, 67, 50, 93, kHeight - 50}};

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
    void deal(TestSession& renderer, std::uint32_t from, int first, std::uint32_t sequence = 1, GLenum by = GL_LESS,
              std::span<const Band> bands = {}) {
        Batch begin;
        pack::PartialBegin(begin.buffer(), kSurface, by, std::as_bytes(std::span(kReceivers)));
        renderer.expect_run(begin);
        for (const int which : {first, first + 1}) draw(renderer, kPartial, which, true, by == GL_BLEND);
        Batch send;
        pack::PartialSend(send.buffer(), kSurface, sequence, from, RequestId(5), std::as_bytes(bands));
        renderer.expect_run(send);
        EXPECT_EQ(renderer.replies[RequestId(5)].size(), sizeof(std::uint64_t)) << "how long it took";
    }
    void deliver(TestSession& renderer) { deliver(renderer, NodeIndex(9), SessionId(1)); }
    /// What it has sent to that node, as that one's session.
    void deliver(TestSession& renderer, NodeIndex to_node, SessionId session) {
        for (auto& [to, message] : renderer.partials) {
            if (to != to_node) continue;
            const auto put = box_.put(session, std::move(message));
            EXPECT_TRUE(put) << put.error().message;
        }
        std::erase_if(renderer.partials, [&](const auto& sent) { return sent.first == to_node; });
    }
    /// Node `self` composes its bands of what those nodes have drawn, for node 9.
    static Batch composing(std::uint32_t self, std::span<const std::uint32_t> nodes, std::uint32_t sequence = 1,
                           GLenum by = GL_LESS) {
        std::vector<std::uint32_t> words(nodes.begin(), nodes.end());
        for (const Band& band : kBands) {
            if (band.node != self) continue;
            for (const std::uint32_t word :
                 {band.name, 9u, band.layer, static_cast<std::uint32_t>(band.x), static_cast<std::uint32_t>(band.y),
                  static_cast<std::uint32_t>(band.width), static_cast<std::uint32_t>(band.height)})
                words.push_back(word);
        }
        Batch batch;
        pack::PartialCompose(batch.buffer(), kSurface, sequence, by, self, static_cast<std::uint32_t>(nodes.size()),
                             std::as_bytes(std::span(words)));
        return batch;
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

TEST_F(PartialPicturesOfNodes, AreTheSameIfOthersPutThemTogether) {
    TestSession shows(*node_.node, SessionId(1)), alone(*node_.node, SessionId(2)), first(*node_.node, SessionId(3)),
        second(*node_.node, SessionId(4)), upper(*node_.node, SessionId(6)), lower(*node_.node, SessionId(7));
    for (TestSession* session : {&shows, &alone, &first, &second, &upper, &lower}) open(*session, wire::kTilesOnly);
    std::uint32_t sequence = 0;
    for (const GLenum by : {GL_LESS, GL_BLEND}) {
        const bool blends = by == GL_BLEND;
        ++sequence;
        for (TestSession* session : {&shows, &alone}) clear(*session);
        for (int which = 0; which < 4; ++which) draw(alone, 3, which, false, blends);
        deal(first, kRenderers[0], 0, sequence, by, kBands);
        deal(second, kRenderers[1], 2, sequence, by, kBands);
        for (TestSession* renderer : {&first, &second}) {
            EXPECT_EQ(renderer->partials.size(), std::size(kBands));
            deliver(*renderer, NodeIndex(6), SessionId(6));
            deliver(*renderer, NodeIndex(7), SessionId(7));
            EXPECT_TRUE(renderer->partials.empty()) << "all goes to those who compose";
        }
        upper.expect_run(composing(6, kRenderers, sequence, by));
        lower.expect_run(composing(7, kRenderers, sequence, by));
        for (TestSession* compositor : {&upper, &lower}) {
            EXPECT_EQ(compositor->partials.size(), 2u) << "one for each tile";
            deliver(*compositor);
        }
        shows.expect_run(merging(kCompositors, sequence, by));
        if (blends) EXPECT_LE(apart(read(shows), read(alone)), 2) << "each part is rounded by itself";
        else EXPECT_EQ(differ(shows, alone), 0u);
    }
    EXPECT_EQ(shows.session.work.partials_missed + upper.session.work.partials_missed, 0u);
}

TEST_F(PartialPicturesOfNodes, AreComposedAlsoWhereNothingWasDrawnOrDoesNotCome) {
    TestSession shows(*node_.node, SessionId(1)), first(*node_.node, SessionId(3)), upper(*node_.node, SessionId(6));
    for (TestSession* session : {&shows, &first, &upper}) open(*session, wire::kTilesOnly);
    clear(shows);
    const auto before = read(shows);
    Batch begin;
    pack::PartialBegin(begin.buffer(), kSurface, GL_LESS, std::as_bytes(std::span(kReceivers)));
    pack::PartialSend(begin.buffer(), kSurface, 1, kRenderers[0], RequestId(), std::as_bytes(std::span(kBands)));
    first.expect_run(begin);
    deliver(first, NodeIndex(6), SessionId(6));
    box_.set_nodes(SessionId(6), {NodeIndex(kRenderers[1])});
    box_.set_nodes(SessionId(6), {});  // it is gone
    upper.expect_run(composing(6, kRenderers));
    EXPECT_EQ(upper.session.work.partials_missed, 2u);
    deliver(upper);
    shows.expect_run(merging(std::span(kCompositors).first(1)));
    EXPECT_EQ(read(shows), before);
    EXPECT_EQ(shows.session.work.partials_missed, 0u);
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
    constexpr Band kNoLayer[] = {{2, 6, 64, 0, 0, 10, 10}}, kBeside[] = {{0, 6, 64, 60, 0, 20, 10}},
                   kBehind[] = {{0, 6, 64, 0, 0, 10, kHeight + 1}};
    const auto bands = [&](std::span<const Band> these) {
        return refused([&](auto& b) {
            pack::PartialBegin(b, kSurface, GL_LESS, std::as_bytes(std::span(kReceivers)));
            pack::PartialSend(b, kSurface, 1, 4, RequestId(), std::as_bytes(these));
        });
    };
    EXPECT_THAT(bands(kNoLayer), HasSubstr("in none of the layers"));
    EXPECT_THAT(bands(kBeside), HasSubstr("in none of the layers"));
    EXPECT_THAT(bands(kBehind), HasSubstr("not in the window"));
    const auto composed = [&](GLenum by, std::uint32_t nodes, std::span<const std::byte> parts) {
        return refused([&](auto& b) { pack::PartialCompose(b, kSurface, 1, by, 6, nodes, parts); });
    };
    const std::array<std::byte, 32> words{};
    EXPECT_THAT(composed(GL_ALWAYS, 1, words), HasSubstr("by nothing"));
    EXPECT_THAT(composed(GL_LESS, 9, words), HasSubstr("too many nodes"));
    EXPECT_THAT(composed(GL_LESS, 8, words), HasSubstr("of nothing"));
    EXPECT_THAT(composed(GL_LESS, 2, words), HasSubstr("whole number of bands"));
    EXPECT_THAT(composed(GL_LESS, 1, words), HasSubstr("not in the window"));
}

}  // namespace
}  // namespace wall::tileserver::test
