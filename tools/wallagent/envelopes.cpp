// SPDX-License-Identifier: MIT
#include "tools/wallagent/envelopes.h"

namespace wall::wallagent {
namespace {

// No door, no address: a program must not show its ticket to another machine in clear.
void lead_through_door(proto::NodeUp& node, const DoorFor& door_for) {
    if (node.key().empty()) return;
    node.set_address(door_for(node.key(), node.address()));
    node.clear_key();
}

void lead_all(google::protobuf::RepeatedPtrField<proto::NodeUp>& nodes, const DoorFor& door_for) {
    for (auto& node : nodes) lead_through_door(node, door_for);
}

}  // namespace

void lead_through_doors(proto::Envelope& envelope, const DoorFor& door_for) {
    if (envelope.has_client_welcome()) lead_all(*envelope.mutable_client_welcome()->mutable_nodes(), door_for);
    else if (envelope.has_placement()) lead_all(*envelope.mutable_placement()->mutable_nodes(), door_for);
    else if (envelope.has_node_up()) lead_through_door(*envelope.mutable_node_up(), door_for);
}

bool programs_may_say(const proto::Envelope& envelope) {
    return !envelope.has_host_hello() && !envelope.has_join_request() && !envelope.has_node_hello() &&
           !envelope.has_program_ended();
}

}  // namespace wall::wallagent
