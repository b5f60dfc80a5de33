// SPDX-License-Identifier: MIT
// Pictures of the wall, each made once for all who want the same: a few are made at a time, more wait in line, and
// whoever comes when the line is full is told to come again. A request shares a picture that nobody has begun to take;
// one that has been begun may be older than what the request wants to see. One thread, but for the composing and
// encoding, which are a pure function on a thread of their own: swaps do not wait for a PNG.
//
//   waiting --a place is free--> asked (nodes send their tiles in parts) --all there, or a node says nothing for too
//   long--> composed and encoded --> done
#pragma once

#include <boost/asio/thread_pool.hpp>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/daemon/changed.h"
#include "walld/streams/picture.h"
#include "walld/wall/wall.h"

namespace wall::walld {

namespace asio = boost::asio;

struct SnapshotQuery {
    std::string tile;              ///< empty: the whole wall
    std::optional<Target> target;  ///< only this surface's session, and only its rectangle
    bool output = false;           ///< of a tile: what its output shows, in its pixels

    bool operator==(const SnapshotQuery& other) const {
        const auto key = [](const SnapshotQuery& of) {
            return of.target ? SurfaceKey{of.target->session, of.target->surface} : SurfaceKey{};
        };
        return tile == other.tile && key(*this) == key(other) && output == other.output;
    }
};

/// PNG, shared by all who asked for it.
using Png = std::shared_ptr<const std::string>;

class SnapshotDesk {
public:
    static constexpr std::chrono::seconds kLimit{5};  ///< a node that has said nothing for so long is left out
    static constexpr std::size_t kAtOnce = 2;         ///< pictures that are being made
    static constexpr std::size_t kMaxWaiting = 32;    ///< different ones that wait to be made

    SnapshotDesk(const asio::any_io_executor& executor, const Wall& wall, Outbox& out)
        : executor_(executor), wall_(wall), out_(out) {}

    /// What the wall shows, not earlier than now.
    asio::awaitable<Outcome<Png>> take(SnapshotQuery query);

    void arrived(NodeIndex node, proto::Snapshot& snapshot);
    void node_left(NodeIndex node);

private:
    struct Job {
        Job(const asio::any_io_executor& executor, SnapshotQuery wanted)
            : query(std::move(wanted)), changed(executor) {}
        SnapshotQuery query;
        PictureJob picture;
        std::size_t missing = 0;  // tiles
        Clock::time_point heard;  // when a node last said something
        net::Changed changed;     // something came, or the result is there
        std::optional<Outcome<Png>> result;
    };
    /// A tile that has not all come.
    struct Pending {
        std::shared_ptr<Job> job;
        std::size_t tile;
        NodeIndex node;
    };
    Outcome<std::shared_ptr<Job>> join(SnapshotQuery query);
    void begin_next();
    asio::awaitable<void> make(std::shared_ptr<Job> job);
    asio::awaitable<Outcome<Png>> picture_of(const std::shared_ptr<Job>& job);
    Outcome<void> ask_nodes(const std::shared_ptr<Job>& job);
    void ask(const std::shared_ptr<Job>& job, NodeIndex node, std::uint32_t slot, SessionId session);
    static geom::Rect place_of(const SnapshotQuery& query, const config::TileConfig& tile);
    void finish(std::map<PictureId, Pending>::iterator pending);

    asio::any_io_executor executor_;
    const Wall& wall_;
    Outbox& out_;
    asio::thread_pool composing_{1};
    std::deque<std::shared_ptr<Job>> waiting_;
    std::size_t being_made_ = 0;
    std::map<PictureId, Pending> pending_;
    PictureId last_id_;
};

}  // namespace wall::walld
