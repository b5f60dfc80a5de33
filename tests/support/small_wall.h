// SPDX-License-Identifier: MIT
// A wall to test with: two nodes side by side, and an outbox for tests that do not look at what is told to nodes and
// programs.
#pragma once

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

}  // namespace wall::walld
