// SPDX-License-Identifier: MIT
// For tests that do not look at what the wall tells its nodes and programs.
#pragma once

#include "walld/wall.h"

namespace wall::walld {

class NoOutbox : public Outbox {
public:
    void to_node(NodeIndex, const proto::Envelope&) override {}
    void to_client(SessionId, const proto::Envelope&) override {}
    void to_member(SessionId, Rank, const proto::Envelope&) override {}
    void end_session(SessionId, const std::string&) override {}
};

}  // namespace wall::walld
