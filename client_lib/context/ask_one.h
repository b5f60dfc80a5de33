// SPDX-License-Identifier: MIT
// Questions that any node can answer, such as what its driver says about a shader. Application threads.
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/follow/session.h"

namespace wall::client {

struct NodeAnswer {
    Node* node = nullptr;
    std::vector<std::byte> bytes;
};

/// One node's answer; the next one's if it is lost meanwhile. Nothing: no node answers. `pack(buffer, request)` packs
/// the question, or `pack(buffer, request, node)`; `function` is for the count of round trips.
template <class Pack>
std::optional<NodeAnswer> ask_one_node(Context& c, const char* function, Pack&& pack) {
    c.flush_block();
    ClientSession& session = c.session();
    std::vector<Node*> nodes;
    {
        std::lock_guard lock(session.mutex());
        for (const auto& node : session.nodes())
            if (node->answers()) nodes.push_back(node.get());
    }
    for (Node* node : nodes) {
        const auto question = [&](wire::PackBuffer& buffer, RequestId request) {
            if constexpr (std::is_invocable_v<Pack, wire::PackBuffer&, RequestId, Node&>) pack(buffer, request, *node);
            else pack(buffer, request);
        };
        if (auto bytes = session.ask(c.draw_source(), *node, function, question))
            return NodeAnswer{node, std::move(*bytes)};
    }
    return std::nullopt;
}

}  // namespace wall::client
