// SPDX-License-Identifier: MIT
// Two walls, one after the other, between nodes and programs that live on and give back what the first one left them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"
#include "walld/wall/messages.h"

namespace wall::walld {
namespace {

using ::testing::ElementsAre;

/// What the nodes and programs have been told, as far as they keep it.
class Kept : public Outbox {
public:
    void to_node(NodeIndex node, const proto::Envelope& message) override {
        last[node] = message;
        if (message.has_wall_note()) wall_notes[node] = message.wall_note();
        if (message.has_ticket()) tickets[node][message.ticket().session()] = message.ticket().ticket();
        if (message.has_session_end()) tickets[node].erase(message.session_end().session());
        if (message.has_stacking()) stacking[node] = message.stacking();
    }
    void to_client(SessionId session, const proto::Envelope& message) override {
        if (message.has_surface_note()) notes[session] = message.surface_note().note();
        if (message.has_placement()) placements[session] = message.placement();
    }
    void to_member(SessionId session, Rank, const proto::Envelope& message) override {
        if (message.has_client_welcome()) welcomes[session] = message.client_welcome();
    }
    void end_session(SessionId, const std::string&) override {}

    std::map<NodeIndex, proto::Envelope> last;
    std::map<NodeIndex, proto::WallNote> wall_notes;
    std::map<NodeIndex, std::map<std::uint32_t, std::string>> tickets;
    std::map<NodeIndex, proto::Stacking> stacking;
    std::map<SessionId, std::string> notes;
    std::map<SessionId, proto::Placement> placements;
    std::map<SessionId, proto::ClientWelcome> welcomes;
};

class AWallThatReturns : public ::testing::Test {
protected:
    AWallThatReturns() { begin(); }
    void begin() {
        wall_ = std::make_unique<Wall>(*config::parse_config(kTwoNodes, "test"), out_, [this](std::size_t bytes) {
            return std::string(bytes, static_cast<char>('a' + tickets_++));
        });
        now_ += std::chrono::seconds(1);
    }
    NodeIndex join(const std::string& name, std::uint64_t started = 1) {
        const NodeIndex node = name == "left" ? kLeft : kRight;
        proto::NodeHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.set_name(name);
        hello.set_pid(100);
        hello.set_started_us(started);
        for (const auto& [session, ticket] : out_.tickets[node]) {
            auto& known = *hello.add_sessions();
            known.set_session(session);
            known.set_ticket(ticket);
        }
        *hello.mutable_wall_note() = out_.wall_notes[node];
        return *wall_->node_joins(hello, now_);
    }
    void join_both() {
        join("left");
        join("right");
    }
    SessionId open(const proto::ClientHello& hello = {}) {
        return wall_->open_session(hello, {}, now_, [](SessionId) {});
    }
    /// As its program comes back.
    SessionId come_back(SessionId id, std::uint32_t windows = 1) {
        proto::ClientHello hello;
        hello.mutable_resume()->set_session(id.value);
        hello.mutable_resume()->set_windows(windows);
        for (const auto& up : out_.welcomes[id].nodes()) {
            auto& told = *hello.mutable_resume()->add_tickets();
            told.set_node(up.node());
            told.set_ticket(up.ticket());
        }
        return open(hello);
    }
    void open_surface(SessionId id, std::uint32_t width = 100, std::uint32_t height = 80) {
        proto::SurfaceOpen message;
        message.set_surface(1);
        message.set_width(width);
        message.set_height(height);
        ASSERT_TRUE(wall_->open_surface(id, message, now_));
    }
    /// A program of that name comes with a window.
    SessionId open_gears() {
        proto::ClientHello hello;
        hello.set_program("gears");
        const auto id = open(hello);
        open_surface(id);
        return id;
    }
    void bring_back(SessionId id, const geom::Rect& drawn, const std::string& note, SessionId as) {
        proto::SurfaceOpen message;
        message.set_surface(1);
        message.set_width(100);
        message.set_height(80);
        *message.mutable_restore()->mutable_drawn() = to_proto(drawn);
        *message.mutable_restore()->mutable_wanted() = out_.placements[id].rect();
        message.mutable_restore()->set_note(note);
        ASSERT_TRUE(wall_->open_surface(as, message, now_));
    }
    void frames(NodeIndex node, SessionId id, std::uint32_t frame, std::uint32_t shown) {
        proto::Rendered report;
        report.set_session(id.value);
        report.set_surface(1);
        report.set_frame(frame);
        report.set_shown(shown);
        wall_->node_rendered(node, report, now_);
    }
    std::vector<std::uint32_t> bottom_to_top() const {
        std::vector<std::uint32_t> out;
        for (const auto& key : wall_->stacking()) out.push_back(key.session.value);
        return out;
    }
    const SurfaceEntry& surface(SessionId id) const { return *wall_->find({id, SurfaceId(1)}); }

    Kept out_;
    Clock::time_point now_{};
    int tickets_ = 0;
    std::unique_ptr<Wall> wall_;
};

TEST_F(AWallThatReturns, GoesOnWithASessionUnderItsNumberAndItsTickets) {
    join_both();
    open();
    const auto id = open();
    const auto tickets = out_.tickets;
    begin();
    join_both();
    EXPECT_EQ(come_back(id), id);
    EXPECT_EQ(out_.tickets, tickets) << "nobody has to open a stream again";
    EXPECT_EQ(out_.welcomes[id].nodes(0).ticket(), tickets.at(kLeft).at(id.value));
}

TEST_F(AWallThatReturns, GivesNoNumberTwice) {
    join_both();
    open();
    const auto last = open();
    begin();
    join("right");
    EXPECT_EQ(open().value, last.value + 1) << "the programs of the earlier ones may still come";
    EXPECT_EQ(come_back(last), last);
    // A node that comes with sessions of numbers that were given again meanwhile.
    out_.tickets[kLeft] = {{last.value + 1, "of somebody else"}, {77, "later"}};
    join("left");
    EXPECT_NE(out_.tickets[kLeft].at(last.value + 1), "of somebody else") << "it is told the new one's ticket";
    EXPECT_EQ(open().value, 78u);
}

TEST_F(AWallThatReturns, BelievesOnlyWhoHasATicket) {
    join_both();
    const auto id = open();
    begin();
    join_both();
    const auto welcome = out_.welcomes[id];
    for (auto& up : *out_.welcomes[id].mutable_nodes()) up.set_ticket(std::string(Wall::kTicketBytes, '?'));
    EXPECT_NE(come_back(id), id);
    out_.welcomes[id] = welcome;
    EXPECT_EQ(come_back(id), id);
    EXPECT_NE(come_back(id), id) << "it is here already";
}

TEST_F(AWallThatReturns, TakesANodeThatWasStartedMeanwhileWithANewTicket) {
    join_both();
    const auto id = open();
    const auto tickets = out_.tickets;
    begin();
    out_.tickets[kRight].clear();
    join("left");
    EXPECT_EQ(come_back(id), id);
    join("right", 2);
    EXPECT_EQ(out_.tickets[kLeft], tickets.at(kLeft));
    EXPECT_NE(out_.tickets[kRight].at(id.value), tickets.at(kRight).at(id.value));
}

TEST_F(AWallThatReturns, HasTheWindowsWhereTheyWereInTheirOrder) {
    join_both();
    const auto a = open(), b = open(), c = open();
    for (const auto id : {a, b, c}) open_surface(id);
    ASSERT_TRUE(wall_->place_surface({a, {}}, {300, 200, 200, 160}, now_));
    ASSERT_TRUE(wall_->raise({a, {}}));
    ASSERT_TRUE(wall_->lower({c, {}}));
    EXPECT_THAT(bottom_to_top(), ElementsAre(c.value, b.value, a.value));
    const auto notes = out_.notes;
    const auto b_rect = surface(b).place.wanted();

    begin();
    join_both();
    const auto other = open();
    open_surface(other);
    for (const auto id : {a, b, c}) come_back(id);
    bring_back(a, {300, 200, 200, 160}, notes.at(a), a);
    bring_back(b, b_rect, notes.at(b), b);
    bring_back(c, {200, 0, 100, 80}, notes.at(c), c);
    EXPECT_EQ(surface(a).place.wanted(), (geom::Rect{300, 200, 200, 160}));
    EXPECT_TRUE(surface(a).scaled);
    EXPECT_EQ(surface(b).place.wanted(), b_rect);
    EXPECT_FALSE(surface(b).scaled);
    EXPECT_THAT(bottom_to_top(), ElementsAre(c.value, b.value, a.value, other.value))
        << "what was opened since lies above";
}

TEST_F(AWallThatReturns, WantsAWindowWhereItWasToMove) {
    join_both();
    const auto id = open();
    open_surface(id);
    ASSERT_TRUE(wall_->place_surface({id, {}}, {640, 0, 100, 80}, now_));  // the program has not drawn there yet
    const auto note = out_.notes[id];
    begin();
    join_both();
    come_back(id);
    bring_back(id, {0, 0, 100, 80}, note, id);
    EXPECT_EQ(surface(id).place.drawn(), (geom::Rect{0, 0, 100, 80}));
    EXPECT_EQ(surface(id).place.wanted(), (geom::Rect{640, 0, 100, 80}));
    EXPECT_EQ(out_.placements[id].rect().x(), 640);
}

TEST_F(AWallThatReturns, HoldsWhatWasHeldAtTheFrameThatIsShown) {
    join_both();
    const auto id = open();
    open_surface(id);
    ASSERT_TRUE(wall_->hold({id, {}}, true, now_));
    EXPECT_TRUE(out_.stacking[kLeft].entries(0).held()) << "the node goes on holding while walld is away";
    const auto note = out_.notes[id];
    begin();
    join_both();
    come_back(id);
    bring_back(id, {0, 0, 100, 80}, note, id);
    EXPECT_TRUE(out_.last[kLeft].has_frames_request());
    frames(kLeft, id, 8, 7);
    EXPECT_TRUE(surface(id).swap.held());
    EXPECT_EQ(surface(id).swap.presented(), 7u);
    ASSERT_TRUE(wall_->step({id, {}}, 1, now_));
    EXPECT_EQ(out_.last[kLeft].present().frame(), 8u);
    EXPECT_TRUE(wall_->sessions().at(id).held) << "so is what the program opens later";
}

TEST_F(AWallThatReturns, LeavesInSightWhatHasNotComeYet) {
    join_both();
    const auto id = open();
    open_surface(id);
    const auto note = out_.notes[id];
    begin();
    join_both();
    EXPECT_THAT(out_.stacking[kLeft].returning(), ElementsAre(id.value));
    come_back(id);
    open_surface(open());
    EXPECT_THAT(out_.stacking[kLeft].returning(), ElementsAre(id.value)) << "its window is still to come";
    bring_back(id, {0, 0, 100, 80}, note, id);
    EXPECT_EQ(out_.stacking[kLeft].returning_size(), 0);
    EXPECT_EQ(out_.stacking[kLeft].entries_size(), 2);
}

TEST_F(AWallThatReturns, DoesNotWaitForEver) {
    join_both();
    const auto id = open();
    begin();
    join_both();
    ASSERT_EQ(wall_->next_deadline(), now_ + Wall::kReturnLimit);
    wall_->tick(now_ + Wall::kReturnLimit);
    EXPECT_FALSE(wall_->next_deadline());
    EXPECT_FALSE(out_.tickets[kLeft].contains(id.value)) << "the nodes forget it";
    EXPECT_NE(come_back(id), id);
}

TEST_F(AWallThatReturns, EndsWhatHasEndedWhileANodeWasAway) {
    join_both();
    const auto id = open();
    const auto tickets = out_.tickets[kRight];
    wall_->node_leaves(kRight, now_);
    wall_->close_session(id);
    out_.tickets[kRight] = tickets;  // it was not told
    join("right");
    EXPECT_FALSE(out_.tickets[kRight].contains(id.value));
}

TEST_F(AWallThatReturns, StillHasTheLayoutThatWaits) {
    join_both();
    Layout layout{1280, 480, {{{"", "gears", ""}, {640, 10, 50, 40}, true, 3}}};
    wall_->load_layout(layout, now_);
    begin();
    join_both();
    const auto id = open_gears();
    EXPECT_EQ(surface(id).place.wanted(), (geom::Rect{640, 10, 50, 40}));
    EXPECT_EQ(surface(id).layout_z, 3u);

    begin();
    join_both();
    const auto second = open_gears();
    EXPECT_NE(surface(second).place.wanted(), (geom::Rect{640, 10, 50, 40})) << "the place was taken once";
}

TEST_F(AWallThatReturns, ALayoutLoadedSinceCountsMore) {
    join("left");
    wall_->load_layout({1280, 480, {{{"", "gears", ""}, {640, 10, 50, 40}, true, 0}}}, now_);
    begin();
    wall_->load_layout({1280, 480, {}}, now_);
    join("left");
    begin();
    join_both();
    const auto id = open_gears();
    EXPECT_EQ(surface(id).place.wanted(), (geom::Rect{0, 0, 100, 80}));
}

TEST_F(AWallThatReturns, IsNotLedAstrayByWhatAProgramSaysOfAPlace) {
    join_both();
    const auto id = open();
    bring_back(id, {5000, 0, 100, 80}, "", id);
    EXPECT_EQ(surface(id).place.wanted(), (geom::Rect{0, 0, 100, 80}));
    const auto other = open();
    bring_back(other, {10, 20, 100, 80}, "\xff nonsense", other);
    EXPECT_EQ(surface(other).place.wanted(), (geom::Rect{100, 0, 100, 80}));
}

}  // namespace
}  // namespace wall::walld
