// SPDX-License-Identifier: MIT
// What the agent changes in the messages that it passes on, and which ones it does not pass on. Pure. Any thread.
#pragma once

#include <functional>
#include <string>

#include "proto/control.pb.h"

namespace wall::wallagent {

/// Where on this machine a program reaches the node that is at `address` and proves `key` (NodeUp.key); empty: nowhere.
using DoorFor = std::function<std::string(const std::string& key, const std::string& address)>;

/// Of a message from walld to a program: nodes on other machines are where their doors are. A node without a key is
/// left as it is: its port is one of walld's machine.
void lead_through_doors(proto::Envelope& envelope, const DoorFor& door_for);

/// False for what only machines say: a program that says it wants to be somebody else.
bool programs_may_say(const proto::Envelope& envelope);

}  // namespace wall::wallagent
