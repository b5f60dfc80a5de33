// SPDX-License-Identifier: MIT
// Geometry that is dealt to two nodes, of which the second one has no tile.
#include "client_lib/follow/dealer.h"

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <thread>

#include "client_lib/follow/followers.h"
#include "common/glstate/elements.h"
#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {
namespace {

using glapi::Op;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr NodeIndex kShows(0), kDraws(1);
constexpr ContextId kContext(1);
constexpr std::uint64_t kLeft = 1, kRight = 2;
constexpr std::size_t kBandBytes = 28;

struct NoObjects final : UsedObjects {
    void for_each_used(const std::function<void(const Object&)>&) override {}
};

/// A window of 100x100 pixels on two tiles of the first node.
class ADealer : public testing::Test {
protected:
    ADealer() {
        std::thread node_sides([this] {
            for (auto& fake : fakes) EXPECT_TRUE(fake.welcome([] {}));
        });
        std::vector<NodeInfo> infos;
        for (const NodeIndex index : {kShows, kDraws})
            infos.push_back({index, fakes[index.value].listener.address(), "ticket", 1, true, false, true});
        nodes.connect_and_wait(infos);
        node_sides.join();
        surface.layout.width = surface.layout.height = 100;
        surface.layout.rect = {0, 0, 100, 100};
        surface.layout.version = 1;
        surface.layout.layers = {tile_layer(surface.layout, kShows, 0, {0, 0, 50, 100}),
                                 tile_layer(surface.layout, kShows, 1, {50, 0, 50, 100})};
        open[surface.id] = &surface;
        glstate::el::depth_test::ref(state) = 1;
    }
    DrawSource source() {
        const DrawTarget target(surface);
        return {kContext, state, target, target, used, objects, share};
    }
    void draw(const std::optional<PixelRect>& box, double elements, std::uint32_t pieces = 0) {
        Drawn drawn(box);
        drawn.elements = elements;
        drawn.pieces = pieces;
        draw_on(followers, source(), drawn, Needs{}, NamesNone(),
                [](wire::PackBuffer& buffer) { glapi::pack::Begin(buffer, GL_POINTS); });
    }
    void clear() {
        draw_on(followers, source(), std::nullopt, Needs{}, NamesNone(),
                [](wire::PackBuffer& buffer) { glapi::pack::Clear(buffer, GL_COLOR_BUFFER_BIT); });
    }
    void swap() {
        dealer.compose(surface);
        dealer.finish_frame(surface);
    }
    struct Packed {
        std::vector<Op> ops;  ///< without state
        std::vector<std::uint64_t> blocks;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges;  ///< of pieces
        std::size_t bands = 0;                                        ///< of what was drawn
    };
    /// What has come to the node or waits to be sent to it, since it was last asked.
    Packed packed(NodeIndex index) {
        Packed packed;
        Node& node = nodes[index];
        nodes.send(node);
        while (readable(fakes[index.value].stream.get(), 200ms)) {
            const auto frame = fakes[index.value].receive();
            const auto batch = wire::split_batch(frame.payload);
            if (!batch) break;
            std::size_t operand = 0;
            for (auto at = batch->opcodes.rbegin(); at != batch->opcodes.rend(); ++at)
                look(packed, static_cast<Op>(*at), batch->operands, operand);
        }
        return packed;
    }
    static void look(Packed& packed, Op op, std::span<const std::byte> operands, std::size_t& at) {
        std::array<std::uint32_t, 6> words{};
        std::memcpy(words.data(), operands.data() + at, std::min(sizeof words, operands.size() - at));
        if (op == Op::Block) packed.blocks.push_back(words[0] | std::uint64_t{words[1]} << 32);
        if (op == Op::PieceRange) packed.ranges.emplace_back(words[0], words[1]);
        at += glapi::kOpFixedBytes[static_cast<std::size_t>(op)];
        if (op == Op::PartialBegin) at += words[2];
        if (op == Op::PartialMerge || op == Op::PartialCompose) at += words[5];
        if (op == Op::PartialSend) {
            packed.bands += words[4] / kBandBytes;
            at += words[4];
        }
        if (op == Op::State) at += glstate::element_bytes(words[0]);
        if (op != Op::State && op != Op::StateSmall && op != Op::StateRecall) packed.ops.push_back(op);
    }
    std::array<FakeNode, 2> fakes{FakeNode("dealer_shows"), FakeNode("dealer_draws")};
    Nodes nodes{{[](Node&) {}, [] {}, [] {}, [] {}}};
    OpenSurfaces open;
    NodeUpdater updater{nodes};
    HiddenParts hidden{nodes, open};
    std::optional<Parallel> group;
    Dealer dealer{nodes, updater, true, group};
    Sight sight;
    WindowContents windows{nodes, dealer};
    DrawnParts in_parts{nodes, open};
    Followers followers{nodes, updater, hidden, dealer, windows, in_parts, sight};
    ClientSurface surface{SurfaceId(1), {}};
    glstate::State state;
    UseStamp used;
    NoObjects objects;
    std::shared_ptr<ShareGroup> share = std::make_shared<ShareGroup>();
};

const std::vector kTarget{Op::SurfaceCreate, Op::SurfacePlace, Op::Bind};

std::vector<Op> behind_target(std::vector<Op> ops) {
    ops.insert(ops.begin(), kTarget.begin(), kTarget.end());
    return ops;
}

TEST_F(ADealer, GivesTheFirstFrameToTheFirstNode) {
    draw(PixelRect{10, 10, 20, 20}, 5);
    draw(PixelRect{40, 10, 60, 20}, 5);
    swap();
    const Packed shows = packed(kShows);
    EXPECT_EQ(shows.ops, behind_target({Op::PartialBegin, Op::Block, Op::Begin, Op::Block, Op::Begin, Op::PartialSend,
                                        Op::PartialMerge}));
    EXPECT_THAT(shows.blocks, ElementsAre(kPartialBit | kLeft, kPartialBit | kLeft | kRight));
    EXPECT_THAT(packed(kDraws).ops, IsEmpty());
}

// Time goes as the test says: a program that waits for its nodes all the time, and draws twice as many frames dealt.
TEST_F(ADealer, DealsByItselfWhatIsFasterSo) {
    Dealer own{nodes, updater, false, group};
    MeasuredChoice::Time now{1h};
    MeasuredChoice::Clock::duration waited{};
    const auto dealt_of = [&](int frames, bool waits) {
        int dealt = 0;
        for (int i = 0; i < frames; ++i) {
            const bool is_dealt = !own.deal(source(), Reach(), 10).empty();
            dealt += is_dealt;
            const auto took = is_dealt ? 25ms : 50ms;
            now += took;
            waited += waits ? took : 0ms;
            own.compose(surface);
            own.finish_frame(surface);
            own.note_frame(now, waited);
        }
        return dealt;
    };
    EXPECT_EQ(dealt_of(100, true), 0) << "the wall does not let it";
    own.allow_measured(true);
    EXPECT_EQ(dealt_of(100, false), 0) << "it does not wait for nodes";
    dealt_of(40, true);
    EXPECT_GT(dealt_of(1000, true), 900);
    own.allow_measured(false);
    EXPECT_EQ(dealt_of(10, true), 0) << "another wall may not";
}

TEST_F(ADealer, DividesAFrameAsTheOneBeforeHasCost) {
    for (int i = 0; i < 4; ++i) draw(std::nullopt, 10);
    swap();
    packed(kShows);
    for (int i = 0; i < 4; ++i) draw(std::nullopt, 10);
    swap();
    EXPECT_EQ(packed(kShows).ops, (std::vector{Op::PartialBegin, Op::Block, Op::Begin, Op::Block, Op::Begin,
                                               Op::PartialSend, Op::PartialMerge}));
    EXPECT_EQ(packed(kDraws).ops,
              behind_target({Op::PartialBegin, Op::Block, Op::Begin, Op::Block, Op::Begin, Op::PartialSend}));
}

TEST_F(ADealer, KnowsWhoGetsPartsOfADraw) {
    dealer.deal(source(), PixelRect{10, 10, 20, 20}, 1000, 10);
    const NodeMasks& to = dealer.dealt_to();
    ASSERT_EQ(to.size(), 2u) << "each gets half of the pieces";
    EXPECT_EQ(to[0].node, kShows);
    EXPECT_EQ(to[1].node, kDraws);
    for (const NodeMask& part : to) EXPECT_EQ(part.slots, kPartialBit | kLeft);
    dealer.deal(source(), PixelRect{200, 10, 220, 20}, 1000, 10);
    EXPECT_TRUE(dealer.dealt_to().empty()) << "nobody shows it";
}

TEST_F(ADealer, LetsNodesComposeThatMay) {
    nodes[kShows].info.composes = nodes[kDraws].info.composes = true;
    draw(std::nullopt, 1000, 10);
    swap();
    const Packed shows = packed(kShows), draws = packed(kDraws);
    EXPECT_EQ(shows.ops, behind_target({Op::PartialBegin, Op::Block, Op::PieceRange, Op::Begin, Op::PartialSend,
                                        Op::PartialCompose, Op::PartialMerge}));
    EXPECT_EQ(draws.ops, behind_target({Op::PartialBegin, Op::Block, Op::PieceRange, Op::Begin, Op::PartialSend,
                                        Op::PartialCompose}));
    EXPECT_EQ(shows.bands, 4u) << "two of each of two layers";
    EXPECT_EQ(draws.bands, 4u);
}

TEST_F(ADealer, HasNothingComposedThatOneNodeHasDrawn) {
    nodes[kDraws].info.composes = true;
    draw(std::nullopt, 5);
    swap();
    const Packed shows = packed(kShows);
    EXPECT_EQ(shows.ops, behind_target({Op::PartialBegin, Op::Block, Op::Begin, Op::PartialSend, Op::PartialMerge}));
    EXPECT_EQ(shows.bands, 0u);
    EXPECT_THAT(packed(kDraws).ops, IsEmpty());
}

TEST_F(ADealer, DividesALargeDrawByItsPieces) {
    draw(std::nullopt, 1000, 10);
    swap();
    EXPECT_THAT(packed(kShows).ranges, ElementsAre(std::pair(0u, 5u)));
    EXPECT_THAT(packed(kDraws).ranges, ElementsAre(std::pair(5u, 10u)));
    draw(std::nullopt, 250);
    draw(std::nullopt, 750, 6);
    swap();
    EXPECT_THAT(packed(kShows).ranges, ElementsAre(std::pair(0u, 2u)));
    EXPECT_THAT(packed(kDraws).ranges, ElementsAre(std::pair(2u, 6u)));
}

TEST_F(ADealer, ComposesBeforeAnythingElseIsDrawn) {
    draw(std::nullopt, 5);
    clear();
    EXPECT_EQ(packed(kShows).ops, behind_target({Op::PartialBegin, Op::Block, Op::Begin, Op::PartialSend,
                                                 Op::PartialMerge, Op::Block, Op::Clear}));
    swap();
    EXPECT_THAT(packed(kShows).ops, IsEmpty()) << "nothing was dealt since";
}

TEST_F(ADealer, ComposesWhatIsTestedOtherwiseApart) {
    draw(std::nullopt, 5);
    glstate::el::depth_func::ref(state) = GL_GREATER;
    state.ids.renew(static_cast<std::size_t>(glstate::Category::depth_stencil));
    draw(std::nullopt, 5);
    swap();
    EXPECT_EQ(packed(kShows).ops,
              behind_target({Op::PartialBegin, Op::Block, Op::Begin, Op::PartialSend, Op::PartialMerge,
                             Op::PartialBegin, Op::Block, Op::Begin, Op::PartialSend, Op::PartialMerge}));
}

TEST_F(ADealer, SendsNobodyWhatNoTileShows) {
    draw(PixelRect{200, 200, 300, 300}, 5);
    swap();
    EXPECT_THAT(packed(kShows).ops, IsEmpty());
    EXPECT_THAT(packed(kDraws).ops, IsEmpty());
}

TEST_F(ADealer, LeavesTheRestToTheTiles) {
    draw(PixelRect{10, 10, 20, 20}, 0);
    glstate::el::blend_enabled::ref(state) = 1;
    draw(PixelRect{10, 10, 20, 20}, 5);
    const Packed shows = packed(kShows);
    EXPECT_THAT(shows.blocks, ElementsAre(kLeft, kLeft));
    EXPECT_THAT(packed(kDraws).ops, IsEmpty());
}

TEST_F(ADealer, DoesNotDealWindowsThatCannotBeComposed) {
    const auto dealt = [&] {
        surface.deal = {};
        draw(std::nullopt, 5);
        const auto blocks = packed(kShows).blocks;
        return blocks.size() == 1 && (blocks.front() & kPartialBit) != 0;
    };
    EXPECT_TRUE(dealt());
    surface.layout.rect.width = 200;
    EXPECT_FALSE(dealt()) << "it is scaled";
    surface.layout.rect.width = 100;
    surface.whole = true;
    EXPECT_FALSE(dealt()) << "every node draws all of it";
    surface.whole = false;
    Dealer unwanted(nodes, updater, false);
    EXPECT_THAT(unwanted.deal(source(), std::nullopt, 5), IsEmpty());
}

/// The second process of two: the second node draws what it is dealt.
struct ADealerOfAProcess : ADealer {
    ADealerOfAProcess() {
        group = Parallel{"", 1, 2};
        glstate::el::depth_test::ref(state) = 0;
        glstate::el::blend_enabled::ref(state) = 1;
        glstate::el::blend_func::ref(state) = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
        open[surface.id] = &surface;
    }
};

TEST_F(ADealerOfAProcess, DrawsBeforeItsTurnWhatLiesOverTheOthers) {
    dealer.take_semaphore(open, kContext, 3);
    draw(std::nullopt, 5);
    swap();
    const Packed draws = packed(kDraws);
    EXPECT_EQ(draws.ops, behind_target({Op::PartialBegin, Op::Block, Op::Begin, Op::PartialSend, Op::SemaphoreP}));
    EXPECT_THAT(draws.blocks, ElementsAre(kPartialBit | kLeft | kRight));
    EXPECT_EQ(packed(kShows).ops.front(), Op::SemaphoreP) << "what is seen is held at once";
}

TEST_F(ADealerOfAProcess, WaitsForItsTurnBeforeAnythingElse) {
    dealer.take_semaphore(open, kContext, 3);
    dealer.take_semaphore(open, kContext, 4);
    EXPECT_THAT(packed(kDraws).ops, IsEmpty());
    clear();
    EXPECT_EQ(packed(kDraws).ops, (std::vector{Op::SemaphoreP, Op::SemaphoreP}));
    swap();
    EXPECT_THAT(packed(kDraws).ops, IsEmpty()) << "once";
}

TEST_F(ADealerOfAProcess, IsNotTheOnlyOneThatBlends) {
    group.reset();
    draw(std::nullopt, 5);
    EXPECT_THAT(packed(kShows).blocks, ElementsAre(kLeft | kRight)) << "one program's blending is not dealt";
}

}  // namespace
}  // namespace wall::client
