// SPDX-License-Identifier: MIT
#include "tools/wallagent/envelopes.h"
#include "tools/wallagent/places.h"
#include "tools/wallagent/user_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::wallagent {
namespace {

std::string door_of(const std::string& key, const std::string& address) { return "unix:/" + key + "," + address; }

void fill(proto::NodeUp& node, const char* address, const char* key) {
    node.set_node(3);
    node.set_address(address);
    node.set_ticket("t");
    node.set_incarnation(2);
    node.set_key(key);
}

void expect_at(const proto::NodeUp& node, const char* address) {
    EXPECT_EQ(node.address(), address);
    EXPECT_EQ(node.key(), "");
    EXPECT_EQ(node.node(), 3u);
    EXPECT_EQ(node.ticket(), "t");
    EXPECT_EQ(node.incarnation(), 2u);
}

TEST(WallagentEnvelopes, LeadAllNodesOfAWelcomeThroughDoors) {
    proto::Envelope envelope;
    auto& welcome = *envelope.mutable_client_welcome();
    welcome.set_session(7);
    fill(*welcome.add_nodes(), "a:1", "k");
    fill(*welcome.add_nodes(), "b:2", "l");
    lead_through_doors(envelope, door_of);
    expect_at(welcome.nodes(0), "unix:/k,a:1");
    expect_at(welcome.nodes(1), "unix:/l,b:2");
    EXPECT_EQ(welcome.session(), 7u);
}

TEST(WallagentEnvelopes, LeadANodeThatComesThroughADoor) {
    proto::Envelope envelope;
    fill(*envelope.mutable_node_up(), "a:1", "k");
    lead_through_doors(envelope, door_of);
    expect_at(envelope.node_up(), "unix:/k,a:1");
}

TEST(WallagentEnvelopes, LeadTheNodesOfAPlacementThroughDoors) {
    proto::Envelope envelope;
    fill(*envelope.mutable_placement()->add_nodes(), "a:1", "k");
    lead_through_doors(envelope, door_of);
    expect_at(envelope.placement().nodes(0), "unix:/k,a:1");
}

TEST(WallagentEnvelopes, LeaveANodeWithoutAKeyWhereItIs) {
    proto::Envelope envelope;
    fill(*envelope.mutable_node_up(), "unix:/run/wallgl/node.sock", "");
    lead_through_doors(envelope, door_of);
    expect_at(envelope.node_up(), "unix:/run/wallgl/node.sock");
}

TEST(WallagentEnvelopes, NameNoAddressWhereThereIsNoDoor) {
    proto::Envelope envelope;
    fill(*envelope.mutable_node_up(), "a:1", "k");
    lead_through_doors(envelope, [](const auto&, const auto&) { return ""; });
    expect_at(envelope.node_up(), "");
}

TEST(WallagentEnvelopes, LeaveOtherMessagesAsTheyAre) {
    proto::Envelope envelope;
    envelope.mutable_refused()->set_reason("r");
    const auto before = envelope.SerializeAsString();
    lead_through_doors(envelope, door_of);
    EXPECT_EQ(envelope.SerializeAsString(), before);
}

TEST(WallagentEnvelopes, LetNoProgramSpeakAsAMachine) {
    proto::Envelope envelope;
    envelope.mutable_client_hello();
    EXPECT_TRUE(programs_may_say(envelope));
    envelope.mutable_operator_request();
    EXPECT_TRUE(programs_may_say(envelope));
    envelope.mutable_host_hello();
    EXPECT_FALSE(programs_may_say(envelope));
    envelope.mutable_node_hello();
    EXPECT_FALSE(programs_may_say(envelope));
    envelope.mutable_join_request();
    EXPECT_FALSE(programs_may_say(envelope));
    envelope.mutable_program_ended();
    EXPECT_FALSE(programs_may_say(envelope));
}

TEST(WallagentPlaces, AreFreeAgainWhenTheirOwnersHaveGone) {
    Places places(2);
    auto one = places.take(), two = places.take();
    ASSERT_TRUE(one && two);
    EXPECT_FALSE(places.take());
    one.reset();
    EXPECT_TRUE(places.take());
}

TEST(WallagentPlaces, EndAllThatAreTaken) {
    Places places(3);
    auto one = places.take(), two = places.take();
    const auto without_an_end = places.take();
    one->ends_with([&] { one.reset(); });
    int ended = 0;
    two->ends_with([&] { ++ended; });
    places.end_all();
    EXPECT_EQ(ended, 1);
    EXPECT_TRUE(places.take()) << "the first one has gone";
}

TEST(WallagentPlaces, MayOutliveThem) {
    std::shared_ptr<Places::Place> place;
    {
        Places places(1);
        place = places.take();
    }
    place.reset();
}

TEST(WallagentUserName, IsTheNumberOfWhoHasNone) {
    EXPECT_EQ(name_of_user(0), "root");
    EXPECT_EQ(name_of_user(4123456789u), "4123456789");
}

}  // namespace
}  // namespace wall::wallagent
