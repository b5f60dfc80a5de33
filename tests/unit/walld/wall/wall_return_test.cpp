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
        if (message.has_ticket()) left[message.ticket().session()] = message.ticket().left();
        if (message.has_session_end()) tickets[node].erase(message.session_end().session());
        if (message.has_stacking()) stacking[node] = message.stacking();
    }
    void to_client(SessionId session, const proto::Envelope& message) override {
        if (message.has_surface_note()) notes[session] = message.surface_note().note();
        if (message.has_placement()) placements[session] = message.placement();
        if (message.has_node_down()) downs.push_back(message.node_down().node());
        if (message.has_placement()) offered.push_back(message.placement());
        if (message.has_placement_agreed()) agreed = message.placement_agreed().layout_version();
    }
    void to_member(SessionId session, Rank rank, const proto::Envelope& message) override {
        if (message.has_client_welcome()) welcomes[session] = message.client_welcome();
        if (message.has_surface_note()) members_notes[rank] = message.surface_note().note();
    }
    void end_session(SessionId, const std::string&) override {}

    std::map<NodeIndex, proto::Envelope> last;
    std::map<NodeIndex, proto::WallNote> wall_notes;
    std::map<NodeIndex, std::map<std::uint32_t, std::string>> tickets;
    std::map<std::uint32_t, google::protobuf::RepeatedField<std::uint32_t>> left;
    std::map<NodeIndex, proto::Stacking> stacking;
    std::map<SessionId, std::string> notes;
    std::map<Rank, std::string> members_notes;  // to one alone
    std::map<SessionId, proto::Placement> placements;
    std::vector<proto::Placement> offered;  // to all members of a parallel program
    std::uint32_t agreed = 0;               // version that was agreed last
    std::vector<std::uint32_t> downs;       // nodes that programs were told to be gone
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
            *known.mutable_left() = out_.left[session];
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
    ASSERT_TRUE(wall_->place_surface({a, {}}, {300, 200, 200, 160}));
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
    ASSERT_TRUE(wall_->place_surface({id, {}}, {640, 0, 100, 80}));  // the program has not drawn there yet
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
    EXPECT_FALSE(wall_->awaits(id));
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
    wall_->load_layout(layout);
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
    wall_->load_layout({1280, 480, {{{"", "gears", ""}, {640, 10, 50, 40}, true, 0}}});
    begin();
    wall_->load_layout({1280, 480, {}});
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

// ---- a link that was lost, to a walld that lives on ----

TEST_F(AWallThatReturns, TakesAProgramWhoseLinkWasLostUnderItsNumberAndItsTickets) {
    join_both();
    const auto other = open();
    open_surface(other);
    const auto id = open();
    open_surface(id);
    ASSERT_TRUE(wall_->place_surface({id, {}}, {640, 0, 200, 160}));
    ASSERT_TRUE(wall_->hold({id, {}}, true, now_));
    ASSERT_TRUE(wall_->lower({id, {}}));
    const auto tickets = out_.tickets;
    wall_->await_again(id, 0, now_);
    EXPECT_FALSE(wall_->sessions().contains(id));
    EXPECT_TRUE(wall_->awaits(id));
    EXPECT_FALSE(wall_->awaits(other));
    EXPECT_THAT(out_.stacking[kLeft].returning(), ElementsAre(id.value)) << "what it has drawn stays in sight";
    EXPECT_EQ(come_back(id, 1), id);
    EXPECT_TRUE(wall_->awaits(id)) << "its window";
    bring_back(id, {640, 0, 200, 160}, out_.notes[id], id);
    EXPECT_FALSE(wall_->awaits(id));
    EXPECT_EQ(out_.tickets, tickets) << "nobody has to open a stream again";
    EXPECT_EQ(surface(id).place.wanted(), (geom::Rect{640, 0, 200, 160}));
    EXPECT_TRUE(surface(id).swap.held());
    EXPECT_THAT(bottom_to_top(), ElementsAre(id.value, other.value));
    EXPECT_EQ(out_.stacking[kLeft].returning_size(), 0);
    EXPECT_FALSE(wall_->next_deadline());
}

/// It was said while nobody knew that the link was cut, and is not in what the program brings back.
TEST_F(AWallThatReturns, KeepsWhatWasAskedOfAProgramWhileItsLinkWasCut) {
    join_both();
    const auto id = open();
    open_surface(id);
    const auto note = out_.notes[id];
    const auto drawn = surface(id).place.drawn();
    ASSERT_TRUE(wall_->hold({id, {}}, true, now_));
    ASSERT_TRUE(wall_->place_surface({id, {}}, {640, 0, 200, 160}));
    wall_->await_again(id, 0, now_);
    *out_.placements[id].mutable_rect() = to_proto(drawn);  // the program has not got the other one
    EXPECT_EQ(come_back(id), id);
    bring_back(id, drawn, note, id);
    EXPECT_TRUE(surface(id).swap.held());
    EXPECT_EQ(surface(id).place.wanted(), (geom::Rect{640, 0, 200, 160}));
}

TEST_F(AWallThatReturns, AwaitsAProgramWhoseLinkWasLostForAWhileOnly) {
    join_both();
    now_ += 2 * Wall::kReturnLimit;
    wall_->tick(now_);  // whoever was to come from an earlier walld has come
    const auto id = open();
    open_surface(id);
    wall_->await_again(id, 0, now_);
    EXPECT_EQ(wall_->next_deadline(), now_ + Wall::kReturnLimit);
    wall_->tick(now_ + Wall::kReturnLimit);
    EXPECT_FALSE(wall_->next_deadline());
    EXPECT_FALSE(out_.tickets[kLeft].contains(id.value)) << "the nodes forget it";
    EXPECT_EQ(out_.stacking[kLeft].returning_size(), 0);
    EXPECT_NE(come_back(id), id);
}

TEST_F(AWallThatReturns, DoesNotWaitForEverForWindowsEither) {
    join_both();
    now_ += 2 * Wall::kReturnLimit;
    const auto id = open();
    open_surface(id);
    wall_->await_again(id, 0, now_);
    come_back(id, 1);  // and closes its window before it has said anything of it
    EXPECT_EQ(wall_->next_deadline(), now_ + Wall::kReturnLimit);
    wall_->tick(now_ + Wall::kReturnLimit);
    EXPECT_FALSE(wall_->next_deadline());
    EXPECT_EQ(out_.stacking[kLeft].returning_size(), 0);
    EXPECT_TRUE(wall_->sessions().contains(id));
}

TEST_F(AWallThatReturns, ANodeThatComesMeanwhileKeepsWhatItHasOfAProgramWhoseLinkWasLost) {
    join_both();
    now_ += 2 * Wall::kReturnLimit;
    wall_->tick(now_);
    const auto id = open();
    wall_->await_again(id, 0, now_);
    wall_->node_leaves(kRight, now_);
    join("right");
    EXPECT_TRUE(out_.tickets[kRight].contains(id.value));
    EXPECT_EQ(come_back(id), id);
}

TEST_F(AWallThatReturns, TellsNobodyOfANodeWhoseLinkWasLostThatIsBackSoon) {
    join_both();
    const auto id = open();
    open_surface(id);
    out_.downs.clear();
    wall_->node_leaves(kLeft, now_, true);
    EXPECT_FALSE(wall_->nodes()[kLeft].up);
    EXPECT_TRUE(wall_->next_deadline());
    join("left");
    wall_->tick(now_ + Wall::kMissedLimit);
    EXPECT_TRUE(out_.downs.empty()) << "its programs draw on as before";

    wall_->node_leaves(kLeft, now_, true);
    wall_->tick(now_ + Wall::kMissedLimit);
    EXPECT_THAT(out_.downs, ElementsAre(kLeft.value)) << "it is gone";
    join("left");

    wall_->node_leaves(kLeft, now_, true);
    out_.downs.clear();
    join("left", 2);
    EXPECT_THAT(out_.downs, ElementsAre(kLeft.value)) << "it is another process";
}

TEST_F(AWallThatReturns, KnowsAProgramThatComesBeforeItsLinkIsKnownToBeLost) {
    join_both();
    const auto id = open(), other = open();
    proto::Resume resume;
    resume.set_session(id.value);
    auto& told = *resume.add_tickets();
    told.set_node(kLeft.value);
    told.set_ticket(out_.tickets[kLeft].at(id.value));
    EXPECT_TRUE(wall_->is_program_of(id, resume));
    EXPECT_FALSE(wall_->is_program_of(other, resume));
    resume.mutable_tickets(0)->set_ticket(std::string(Wall::kTicketBytes, '?'));
    EXPECT_FALSE(wall_->is_program_of(id, resume));
}

// ---- parallel programs ----

class AParallelProgramThatReturns : public AWallThatReturns {
protected:
    static proto::ClientHello member(Rank rank, std::uint32_t members = 2) {
        proto::ClientHello hello;
        hello.set_pid(1000 + rank);
        hello.mutable_group()->set_name("march");
        hello.mutable_group()->set_rank(rank);
        hello.mutable_group()->set_members(members);
        return hello;
    }
    proto::ClientHello member_again(SessionId id, Rank rank, std::uint32_t windows = 1, std::uint32_t members = 2) {
        auto hello = member(rank, members);
        hello.mutable_resume()->set_session(id.value);
        hello.mutable_resume()->set_windows(windows);
        for (const auto& up : out_.welcomes[id].nodes()) {
            auto& told = *hello.mutable_resume()->add_tickets();
            told.set_node(up.node());
            told.set_ticket(up.ticket());
        }
        return hello;
    }
    SessionId start() {
        join_both();
        const auto id = open(member(0));
        open(member(1));
        for (const Rank rank : {0u, 1u}) announce(id, rank, {}, "");
        return id;
    }
    /// The window, with the placements that the member knows to be agreed; none: it is new.
    void announce(SessionId id, Rank rank, const std::vector<proto::Placement>& agreed, const std::string& note,
                  const geom::Rect& wanted = {0, 0, 100, 80}, std::uint32_t wanted_version = 1) {
        proto::SurfaceOpen message;
        message.set_surface(1);
        message.set_width(100);
        message.set_height(80);
        for (const auto& placement : agreed) {
            auto& restore = *message.mutable_restore();
            *restore.add_agreed() = placement;
            restore.mutable_agreed()->rbegin()->clear_nodes();
            *restore.mutable_drawn() = placement.rect();
            *restore.mutable_wanted() = to_proto(wanted);
            restore.set_wanted_version(wanted_version);
            restore.set_note(note);
        }
        ASSERT_TRUE(wall_->open_surface(id, message, now_, rank));
    }
    void note(SessionId id, Rank rank, std::uint32_t version, std::uint32_t begun = 0) {
        proto::PlacementNoted message;
        message.set_surface(1);
        message.set_layout_version(version);
        message.set_begun(begun);
        wall_->placement_noted(id, rank, message);
    }
    std::vector<proto::Placement> agreed_of(SessionId id) {
        std::vector<proto::Placement> out;
        for (const auto& [version, placement] : surface(id).agreed.versions()) out.push_back(placement);
        return out;
    }
    void another_walld() {
        begin();
        join_both();
        out_.offered.clear();
        out_.agreed = 0;
    }
};

TEST_F(AParallelProgramThatReturns, IsOneSessionUnderItsNumberAndItsTickets) {
    const auto id = start();
    const auto tickets = out_.tickets;
    another_walld();
    for (const Rank rank : {1u, 0u}) {
        EXPECT_EQ(wall_->comeback(member_again(id, rank), now_), Wall::Comeback::may_come);
        EXPECT_EQ(open(member_again(id, rank)), id);
        EXPECT_EQ(out_.welcomes[id].nodes_size(), 2);
    }
    EXPECT_EQ(out_.tickets, tickets) << "nobody has to open a stream again";
    EXPECT_TRUE(wall_->sessions().at(id).group->all_came());
}

TEST_F(AParallelProgramThatReturns, EachProcessKeepsTheNoteOfItsWindow) {
    const auto id = start();
    ASSERT_NE(out_.notes[id], "");
    EXPECT_EQ(out_.members_notes[1], out_.notes[id]) << "it has opened the window when the others had heard of it";
}

TEST_F(AParallelProgramThatReturns, IsAskedForItsPlaceWhenAllAreBack) {
    const auto id = start();
    const auto agreed = agreed_of(id);
    const auto note_of_window = out_.notes[id];
    another_walld();
    for (const Rank rank : {0u, 1u}) open(member_again(id, rank));
    announce(id, 0, agreed, note_of_window, {640, 0, 100, 80}, 2);
    EXPECT_TRUE(out_.offered.empty()) << "one may know more";
    EXPECT_EQ(surface(id).place.drawn(), (geom::Rect{0, 0, 100, 80}));
    announce(id, 1, agreed, note_of_window);
    ASSERT_EQ(out_.offered.size(), 2u);
    EXPECT_TRUE(out_.offered[0].agreed());
    const auto& proposed = out_.offered[1];
    EXPECT_FALSE(proposed.agreed());
    EXPECT_EQ(proposed.rect().x(), 640) << "where it was to move";
    EXPECT_GT(proposed.layout_version(), agreed.back().layout_version());
    EXPECT_EQ(proposed.nodes_size(), 2);
    // The members are beyond that frame: nobody has told this walld which one is shown.
    const auto version = proposed.layout_version();
    note(id, 0, version, 70);
    EXPECT_EQ(out_.offered.back().from_frame(), 75u);
    for (const Rank rank : {0u, 1u}) note(id, rank, out_.offered.back().layout_version());
    EXPECT_EQ(out_.agreed, out_.offered.back().layout_version());
}

TEST_F(AParallelProgramThatReturns, IsWantedWhereItsNewestProposalSays) {
    const auto id = start();
    const auto agreed = agreed_of(id);
    proto::WindowRecord record;
    record.set_scaled(true);
    const auto scaled = record.SerializeAsString();
    for (const Rank knows : {0u, 1u}) {
        another_walld();
        for (const Rank rank : {0u, 1u}) open(member_again(id, rank));
        for (const Rank rank : {0u, 1u}) {
            const geom::Rect wanted{rank == knows ? 640 : 300, 0, 50, 40};
            announce(id, rank, agreed, rank == knows ? scaled : "", wanted, rank == knows ? 6 : 5);
        }
        ASSERT_FALSE(out_.offered.empty());
        EXPECT_EQ(out_.offered.back().rect().x(), 640) << "rank " << knows << " has heard of it";
        EXPECT_EQ(out_.offered.back().rect().width(), 50u) << "of another size than the program's window";
        EXPECT_GT(out_.offered.back().layout_version(), 6u) << "nobody has heard of this one";
    }
}

TEST_F(AParallelProgramThatReturns, TakesWhatAnyMemberKnowsToBeAgreed) {
    const auto id = start();
    const auto before = agreed_of(id);
    ASSERT_TRUE(wall_->place_surface({id, {}}, {300, 0, 100, 80}));
    for (const Rank rank : {0u, 1u}) note(id, rank, out_.placements[id].layout_version());
    const auto after = agreed_of(id);
    ASSERT_EQ(after.size(), 2u);
    another_walld();
    for (const Rank rank : {0u, 1u}) open(member_again(id, rank));
    announce(id, 0, before, "");  // walld was gone before it could tell this one
    announce(id, 1, after, "", {300, 0, 100, 80}, 2);
    ASSERT_EQ(out_.offered.size(), 3u);
    EXPECT_TRUE(out_.offered[1].agreed());
    EXPECT_EQ(out_.offered[1].layout_version(), after[1].layout_version());
    EXPECT_EQ(out_.offered[1].from_frame(), after[1].from_frame());
    EXPECT_EQ(out_.offered[1].nodes_size(), 2);
    EXPECT_EQ(surface(id).place.drawn(), (geom::Rect{300, 0, 100, 80}));
}

TEST_F(AParallelProgramThatReturns, DoesNotWaitForWhoHasLeftOrClosedTheWindow) {
    join_both();
    const auto id = open(member(0, 3));
    for (const Rank rank : {1u, 2u}) open(member(rank, 3));
    for (const Rank rank : {0u, 1u, 2u}) announce(id, rank, {}, "");
    const auto agreed = agreed_of(id);
    wall_->member_leaves(id, 2);
    wall_->close_surface(id, SurfaceId(1), 1);
    another_walld();
    open(member_again(id, 0, 1, 3));
    announce(id, 0, agreed, "");
    EXPECT_TRUE(out_.offered.empty());
    open(member_again(id, 1, 0, 3));
    ASSERT_EQ(out_.offered.size(), 2u) << "rank 2 has left";
    note(id, 0, out_.offered.back().layout_version());
    EXPECT_EQ(out_.agreed, out_.offered.back().layout_version());
}

TEST_F(AParallelProgramThatReturns, GoesOnWhenTheLinkOfAProcessWasLost) {
    const auto id = start();
    const auto agreed = agreed_of(id);
    const auto again = member_again(id, 1);
    const auto admits = [&](const proto::ClientHello& hello) {
        return wall_->sessions().at(id).group->admits(hello.group(), hello.has_resume()).has_value();
    };
    EXPECT_FALSE(admits(again)) << "it is here";
    wall_->await_again(id, 1, now_);
    EXPECT_EQ(wall_->next_deadline(), now_ + Wall::kReturnLimit);
    EXPECT_FALSE(admits(member(1))) << "another process";
    EXPECT_TRUE(admits(again));
    EXPECT_EQ(wall_->comeback(again, now_), Wall::Comeback::may_come);
    EXPECT_EQ(open(again), id);
    EXPECT_FALSE(wall_->next_deadline());
    announce(id, 1, agreed, out_.notes[id]);
    wall_->tick(now_ + 2 * Wall::kReturnLimit);
    EXPECT_TRUE(wall_->sessions().contains(id));
}

/// Else it would not know their tickets when the next walld asks for one.
TEST_F(AParallelProgramThatReturns, IsToldOfNodesOnWhichAProcessWhoseLinkWasLostDraws) {
    const auto id = start();
    for (const bool left : {true, false}) join(left ? "left" : "right", 2);  // they were started anew meanwhile
    auto again = member(1);
    again.mutable_resume()->set_session(id.value);
    for (const NodeIndex node : {kLeft, kRight}) {
        auto& told = *again.mutable_resume()->add_tickets();
        told.set_node(node.value);
        told.set_ticket(out_.tickets[node].at(id.value));
    }
    wall_->await_again(id, 1, now_);
    EXPECT_EQ(open(again), id);
    EXPECT_EQ(out_.welcomes[id].nodes_size(), 2);
}

TEST_F(AParallelProgramThatReturns, EndsWhenAProcessStaysAway) {
    const auto id = start();
    wall_->await_again(id, 1, now_);
    wall_->tick(now_ + Wall::kReturnLimit);
    EXPECT_FALSE(wall_->sessions().contains(id));
    EXPECT_FALSE(wall_->next_deadline());
}

TEST_F(AParallelProgramThatReturns, IsToldWhenItsSessionIsNoMore) {
    const auto id = start();
    const auto again = member_again(id, 0);
    const auto tickets = out_.tickets;
    out_.tickets.clear();
    another_walld();
    EXPECT_EQ(wall_->comeback(again, now_), Wall::Comeback::not_yet) << "another node may know it";
    now_ += Wall::kReturnLimit;
    EXPECT_EQ(wall_->comeback(again, now_), Wall::Comeback::over);
    EXPECT_EQ(wall_->comeback(member(0), now_), Wall::Comeback::may_come);
    out_.tickets = tickets;
    another_walld();
    const auto other = open(member(0));
    EXPECT_NE(other, id);
    EXPECT_EQ(wall_->comeback(again, now_), Wall::Comeback::may_come) << "its nodes know it";
    EXPECT_EQ(open(again), id) << "though another one has its name";
    auto thief = again;
    for (auto& told : *thief.mutable_resume()->mutable_tickets()) told.set_ticket("guessed");
    thief.mutable_group()->set_rank(1);
    EXPECT_EQ(wall_->comeback(thief, now_), Wall::Comeback::not_yet);
}

TEST_F(AParallelProgramThatReturns, IsNotLedAstrayByWhatAMemberSays) {
    const auto id = start();
    auto nowhere = agreed_of(id);
    nowhere[0].mutable_rect()->set_x(9000);
    another_walld();
    for (const Rank rank : {0u, 1u}) open(member_again(id, rank));
    nowhere[0].set_layout_version(40);
    for (const Rank rank : {0u, 1u}) announce(id, rank, nowhere, "", {9000, 0, 100, 80});
    EXPECT_TRUE(surface(id).agreed.versions().empty());
    ASSERT_EQ(out_.offered.size(), 1u);
    EXPECT_FALSE(out_.offered[0].agreed());
    EXPECT_GT(out_.offered[0].layout_version(), 40u);
    EXPECT_TRUE(check_place(wall_->config().canvas(), from_proto(out_.offered[0].rect())));
}

}  // namespace
}  // namespace wall::walld
