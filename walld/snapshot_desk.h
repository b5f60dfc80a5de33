// SPDX-License-Identifier: MIT
// Asks nodes for their tiles' pixels and puts the answers together. One thread, but for the composing, which is a pure
// function on a thread of its own, so that swaps of a large wall do not wait for a PNG.
#pragma once

#include <boost/asio/thread_pool.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "walld/changed.h"
#include "walld/picture.h"
#include "walld/wall.h"

namespace wall::walld {

struct SnapshotQuery {
    std::string tile;              ///< empty: the whole wall
    std::optional<Target> target;  ///< only this surface's session, and only its rectangle
};

class SnapshotDesk {
public:
    static constexpr std::chrono::seconds kLimit{5};  ///< a node that has not answered then is left out

    SnapshotDesk(const asio::any_io_executor& executor, const Wall& wall, Outbox& out)
        : executor_(executor), wall_(wall), out_(out) {}

    /// PNG of what the wall shows now.
    asio::awaitable<Outcome<std::string>> take(SnapshotQuery query);

    void arrived(NodeIndex node, proto::Snapshot& snapshot);
    void node_left(NodeIndex node);

private:
    struct Job {
        explicit Job(const asio::any_io_executor& executor) : done(executor) {}
        PictureJob picture;
        std::size_t missing = 0;
        Changed done;
    };
    struct Pending {
        std::shared_ptr<Job> job;
        std::size_t tile;
        NodeIndex node;
    };
    Outcome<std::shared_ptr<Job>> start(const SnapshotQuery& query);
    void ask(const std::shared_ptr<Job>& job, NodeIndex node, std::uint32_t slot, SessionId session);
    void finish(std::map<std::uint32_t, Pending>::iterator pending);

    asio::any_io_executor executor_;
    const Wall& wall_;
    Outbox& out_;
    asio::thread_pool composing_{1};
    std::map<std::uint32_t, Pending> pending_;
    std::uint32_t last_request_ = 0;
};

}  // namespace wall::walld
