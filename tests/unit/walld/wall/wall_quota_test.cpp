// SPDX-License-Identifier: MIT
// What programs and people may have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"
#include "walld/wall/session_stats.h"

namespace wall::walld {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::uint64_t kMebibyte = 1 << 20;

class Heard : public NoOutbox {
public:
    void to_node(NodeIndex, const proto::Envelope& message) override {
        if (message.has_ticket()) tickets.push_back(message.ticket());
    }
    void end_session(SessionId session, const std::string& reason) override { ended[session] = reason; }
    std::vector<proto::Ticket> tickets;
    std::map<SessionId, std::string> ended;
};

config::WallConfig wall_with(const std::string& quota) {
    return *config::parse_config("[quota]\n" + quota + kTwoNodes, "test");
}

class AWallWithQuotas : public ::testing::Test {
protected:
    explicit AWallWithQuotas(const std::string& quota =
                                 "program_memory = 64\nprogram_objects = 9\n"
                                 "program_bandwidth = 2\nprogram_fps = 30\n"
                                 "program_windows = 2\nperson_programs = 2\n"
                                 "person_memory = 100\n")
        : wall_(wall_with(quota), out_, [](std::size_t bytes) { return std::string(bytes, 'x'); }) {
        proto::NodeHello node;
        node.set_version(wire::kProtocolVersion);
        for (const char* name : {"left", "right"}) {
            node.set_name(name);
            EXPECT_TRUE(wall_.node_joins(node, now_));
        }
    }
    static Person person(const std::string& name) {
        return {Person::Kind::unix_user, name, name == "alice" ? 1u : 2u, Role::user};
    }
    static proto::ClientHello hello() {
        proto::ClientHello out;
        out.set_version(wire::kProtocolVersion);
        return out;
    }
    SessionId open(const std::string& name) {
        return wall_.open_session(hello(), person(name), now_, [](SessionId) {});
    }
    void report(NodeIndex node, const std::map<SessionId, std::uint64_t>& mebibytes) {
        proto::NodeStats stats;
        for (const auto& [session, size] : mebibytes) {
            auto& row = *stats.add_session_stats();
            row.set_session(session.value);
            row.set_memory_bytes(size * kMebibyte);
            row.set_objects(size);
        }
        wall_.node_reports(node, stats);
    }
    Clock::time_point now_{std::chrono::hours(1)};
    Heard out_;
    Wall wall_;
};

TEST_F(AWallWithQuotas, TellsNodesWhatAProgramMayHave) {
    open("alice");
    ASSERT_EQ(out_.tickets.size(), 2u);
    for (const auto& ticket : out_.tickets) {
        EXPECT_EQ(ticket.quota().memory(), 64 * kMebibyte);
        EXPECT_EQ(ticket.quota().objects(), 9u);
        EXPECT_EQ(ticket.quota().bandwidth(), 2 * kMebibyte);
        EXPECT_EQ(ticket.quota().fps(), 30u);
    }
    out_.tickets.clear();
    wall_.describe(wall_with("program_fps = 60\n"));
    ASSERT_EQ(out_.tickets.size(), 2u) << "also those that run";
    EXPECT_EQ(out_.tickets[0].quota().fps(), 60u);
    EXPECT_EQ(out_.tickets[0].quota().memory(), 0u) << "as much as the node gives";
    out_.tickets.clear();
    wall_.describe(wall_with("program_fps = 60\n"));
    EXPECT_TRUE(out_.tickets.empty());
}

TEST_F(AWallWithQuotas, RefusesAPersonsThirdProgram) {
    const auto first = open("alice");
    EXPECT_TRUE(wall_.check_quota(hello(), person("alice")));
    open("alice");
    const auto refused = wall_.check_quota(hello(), person("alice"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, RefusalKind::busy);
    EXPECT_THAT(refused.error().message, HasSubstr("alice has 2 programs on this wall"));
    EXPECT_TRUE(wall_.check_quota(hello(), person("bob")));
    auto back = hello();
    back.mutable_resume()->set_session(7);
    EXPECT_TRUE(wall_.check_quota(back, person("alice"))) << "one that was here before a new walld";
    wall_.close_session(first);
    EXPECT_TRUE(wall_.check_quota(hello(), person("alice")));
}

TEST_F(AWallWithQuotas, RefusesAProgramsThirdWindow) {
    const auto session = open("alice");
    proto::SurfaceOpen window;
    window.set_width(10);
    window.set_height(10);
    for (const std::uint32_t number : {1, 2}) {
        window.set_surface(number);
        EXPECT_TRUE(wall_.open_surface(session, window, now_));
    }
    window.set_surface(3);
    EXPECT_EQ(wall_.open_surface(session, window, now_).error().message,
              "more than 2 windows ('program_windows' in [quota] of wall.toml)");
}

TEST_F(AWallWithQuotas, EndsTheLargestOfWhoeverHasTooMuch) {
    const auto small = open("alice"), large = open("alice"), other = open("bob");
    report(kLeft, {{small, 40}, {large, 60}, {other, 90}});
    report(kRight, {{small, 100}});
    EXPECT_TRUE(out_.ended.empty()) << "each has as much as they may, on each node";
    report(kRight, {{small, 20}, {large, 81}, {other, 90}});
    ASSERT_EQ(out_.ended.size(), 1u);
    EXPECT_THAT(out_.ended.at(large), AllOf(HasSubstr("the programs of alice have 101 MiB of objects on node 'right'"),
                                            HasSubstr("a person may have 100 ('person_memory'")));
    EXPECT_FALSE(wall_.sessions().contains(large));
    report(kRight, {{small, 20}, {large, 81}, {other, 90}});
    EXPECT_EQ(out_.ended.size(), 1u) << "what a node still says of one that has ended is nobody's";
}

TEST_F(AWallWithQuotas, KnowsWhatAProgramHasWhereItHasMost) {
    const auto session = open("alice");
    report(kLeft, {{session, 7}});
    report(kRight, {{session, 5}});
    EXPECT_EQ(held_on_nodes(wall_).at(session).memory_bytes, 7 * kMebibyte);
    EXPECT_EQ(held_on_nodes(wall_).at(session).objects, 7u);
    wall_.node_leaves(kLeft, now_);
    EXPECT_EQ(held_on_nodes(wall_).at(session).memory_bytes, 5 * kMebibyte);
}

TEST_F(AWallWithQuotas, KnowsHowFarANodesClockIsAhead) {
    const std::chrono::system_clock::time_point here(std::chrono::seconds(1'000'000));
    proto::NodeStats stats;
    stats.set_time_us(1'000'002'500'000);
    wall_.node_reports(kLeft, stats, here);
    EXPECT_EQ(wall_.nodes()[kLeft].clock_ahead, std::chrono::milliseconds(2500));
    stats.set_time_us(999'999'000'000);
    wall_.node_reports(kLeft, stats, here);
    EXPECT_EQ(wall_.nodes()[kLeft].clock_ahead, std::chrono::milliseconds(-1000));
    EXPECT_FALSE(wall_.nodes()[kRight].clock_ahead);
}

class AWallWithoutQuotas : public AWallWithQuotas {
protected:
    AWallWithoutQuotas() : AWallWithQuotas("") {}
};

TEST_F(AWallWithoutQuotas, LimitsNobody) {
    for (int i = 0; i < 20; ++i) open("alice");
    EXPECT_TRUE(wall_.check_quota(hello(), person("alice")));
    report(kLeft, {{SessionId(1), 1 << 20}});
    EXPECT_TRUE(out_.ended.empty());
    EXPECT_EQ(out_.tickets[0].quota().memory(), 0u);
}

}  // namespace
}  // namespace wall::walld
