// SPDX-License-Identifier: MIT
// Who records a program is a node of that program alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"
#include "walld/wall/status.h"

namespace wall::walld {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kAddress = "unix:/tmp/recorder";

class Heard : public NoOutbox {
public:
    void to_node(NodeIndex, const proto::Envelope& message) override { nodes.push_back(message); }
    void to_client(SessionId id, const proto::Envelope& message) override { clients[id].push_back(message); }
    std::vector<proto::Envelope> nodes;
    std::map<SessionId, std::vector<proto::Envelope>> clients;
};

class ARecordedProgram : public ::testing::Test {
protected:
    ARecordedProgram() {
        for (const char* name : {"left", "right"}) {
            proto::NodeHello hello;
            hello.set_version(wire::kProtocolVersion);
            hello.set_name(name);
            EXPECT_TRUE(wall_.node_joins(hello, now_));
        }
        session_ = open();
        other_ = open();
        out_.nodes.clear();
        out_.clients.clear();
    }
    SessionId open(const Person& who = {}) {
        return wall_.open_session({}, who, now_, [](SessionId) {});
    }
    std::string refusal(SessionId id, const std::string& address = kAddress) {
        const auto begun = wall_.begin_recording(id, address);
        return begun ? "" : begun.error().message;
    }

    Heard out_;
    Clock::time_point now_{};
    int tickets_ = 0;
    Wall wall_{*config::parse_config(kTwoNodes, "test"), out_,
               [this](std::size_t n) { return std::string(n, static_cast<char>('a' + tickets_++)); }};
    SessionId session_, other_;
};

TEST_F(ARecordedProgram, AloneIsToldOfARecorderThatIsNoNodeOfTheWall) {
    const auto ticket = wall_.begin_recording(session_, kAddress);
    ASSERT_TRUE(ticket);
    EXPECT_EQ(ticket->size(), Wall::kTicketBytes);
    ASSERT_EQ(out_.clients[session_].size(), 1u);
    const auto& up = out_.clients[session_][0].node_up();
    EXPECT_TRUE(up.records());
    EXPECT_EQ(up.address(), kAddress);
    EXPECT_EQ(up.ticket(), *ticket);
    EXPECT_EQ(up.node(), wall_.nodes().size()) << "no node has this number";
    EXPECT_THAT(out_.clients[other_], IsEmpty());
    EXPECT_THAT(out_.nodes, IsEmpty());
    EXPECT_EQ(nodes_json(wall_).size(), 2u);
    EXPECT_TRUE(session_json(wall_, session_)["recorded"]);
    EXPECT_FALSE(session_json(wall_, other_)["recorded"]);
}

TEST_F(ARecordedProgram, IsToldWhenItIsOver) {
    const auto ticket = wall_.begin_recording(session_, kAddress);
    ASSERT_TRUE(ticket);
    EXPECT_TRUE(wall_.is_recorded(session_, *ticket));
    wall_.end_recording(session_, "another ticket");
    EXPECT_TRUE(wall_.is_recorded(session_, *ticket));
    wall_.end_recording(session_, *ticket);
    EXPECT_FALSE(wall_.is_recorded(session_, *ticket));
    EXPECT_EQ(out_.clients[session_].back().node_down().node(), wall_.nodes().size());
    const auto again = wall_.begin_recording(session_, kAddress);
    ASSERT_TRUE(again);
    EXPECT_NE(*again, *ticket);
    EXPECT_GT(out_.clients[session_].back().node_up().incarnation(), 1u);
}

TEST_F(ARecordedProgram, IsOneOfWalldsMachineAndRecordedOnce) {
    EXPECT_THAT(refusal(SessionId(99)), HasSubstr("no session 99"));
    EXPECT_THAT(refusal(session_, "nowhere"), HasSubstr("'address'"));
    EXPECT_EQ(refusal(session_), "");
    EXPECT_THAT(refusal(session_), HasSubstr("already"));
    Person remote{.kind = Person::Kind::host_user, .name = "alice@desk", .machine = "key"};
    EXPECT_THAT(refusal(open(remote)), HasSubstr("another machine"));
}

TEST_F(ARecordedProgram, ThatIsAParallelOneIsNot) {
    proto::ClientHello hello;
    hello.mutable_group()->set_name("group");
    hello.mutable_group()->set_members(2);
    const auto id = wall_.open_session(hello, {}, now_, [](SessionId) {});
    EXPECT_THAT(refusal(id), HasSubstr("parallel program"));
}

TEST_F(ARecordedProgram, IsNotRecordedAnyMoreWhenANodeComesInTheRecordersPlace) {
    const auto ticket = wall_.begin_recording(session_, kAddress);
    ASSERT_TRUE(ticket);
    wall_.describe(*config::parse_config(kTwoNodes, "test"));
    EXPECT_TRUE(wall_.is_recorded(session_, *ticket));
    wall_.describe(*config::parse_config(
        std::string(kTwoNodes) + "[[node]]\nname = \"new\"\n[[node.tile]]\nname = \"n\"\nrect = [0, 480, 640, 480]\n",
        "test"));
    EXPECT_FALSE(wall_.is_recorded(session_, *ticket));
    const auto told_down = [](const proto::Envelope& message) { return message.has_node_down(); };
    EXPECT_EQ(std::ranges::count_if(out_.clients[session_], told_down), 1);
}

}  // namespace
}  // namespace wall::walld
