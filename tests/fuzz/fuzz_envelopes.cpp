// SPDX-License-Identifier: MIT
// What an agent passes on: a program's messages, and walld's with other addresses. No key is left in them, and where
// one was there is a door.
#include <vector>

#include "common/base/assert.h"
#include "tools/wallagent/envelopes.h"

namespace {

using namespace wall;

constexpr const char* kDoor = "unix:/door";

std::vector<const proto::NodeUp*> nodes_in(const proto::Envelope& envelope) {
    std::vector<const proto::NodeUp*> nodes;
    if (envelope.has_node_up()) nodes.push_back(&envelope.node_up());
    for (const auto& node : envelope.client_welcome().nodes()) nodes.push_back(&node);
    for (const auto& node : envelope.placement().nodes()) nodes.push_back(&node);
    return nodes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    proto::Envelope envelope;
    if (!envelope.ParseFromArray(data, static_cast<int>(size))) return 0;
    (void)wallagent::programs_may_say(envelope);
    const proto::Envelope before = envelope;
    wallagent::lead_through_doors(envelope, [](const std::string&, const std::string&) { return kDoor; });
    WALL_ASSERT(envelope.message_case() == before.message_case());
    const auto was = nodes_in(before), is = nodes_in(envelope);
    WALL_ASSERT(was.size() == is.size());
    for (std::size_t i = 0; i < is.size(); ++i)
        WALL_ASSERT(is[i]->key().empty() && is[i]->address() == (was[i]->key().empty() ? was[i]->address() : kDoor));
    return 0;
}
