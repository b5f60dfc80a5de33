// SPDX-License-Identifier: MIT
// A wall to test with: two nodes side by side, and outboxes for tests that look at what is told to nodes and programs,
// or do not.
#pragma once

#include <map>
#include <vector>

#include "walld/wall/wall.h"

namespace wall::walld {

inline constexpr const char* kTwoNodes = R"(
[[node]]
name = "left"
[[node.tile]]
name = "l"
rect = [0, 0, 640, 480]
[[node]]
name = "right"
[[node.tile]]
name = "r"
rect = [640, 0, 640, 480]
)";
inline constexpr NodeIndex kLeft(0), kRight(1);

class NoOutbox : public Outbox {
public:
    void to_node(NodeIndex, const proto::Envelope&) override {}
    void to_client(SessionId, const proto::Envelope&) override {}
    void to_member(SessionId, Rank, const proto::Envelope&) override {}
    void end_session(SessionId, const std::string&) override {}
};

/// One that keeps what each node and the one program are told.
class HearingOutbox : public NoOutbox {
public:
    void to_node(NodeIndex node, const proto::Envelope& message) override { nodes[node].push_back(message); }
    void to_client(SessionId, const proto::Envelope& message) override { client.push_back(message); }
    std::map<NodeIndex, std::vector<proto::Envelope>> nodes;
    std::vector<proto::Envelope> client;
};

}  // namespace wall::walld
