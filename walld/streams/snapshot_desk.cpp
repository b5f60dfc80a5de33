// SPDX-License-Identifier: MIT
#include "walld/streams/snapshot_desk.h"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "walld/wall/messages.h"

namespace wall::walld {
namespace {

asio::awaitable<Result<std::string>> compose(PictureJob job) { co_return compose_png(std::move(job)); }

}  // namespace

asio::awaitable<Outcome<Png>> SnapshotDesk::take(SnapshotQuery query) {
    const auto job = join(std::move(query));
    if (!job) co_return tl::unexpected(job.error());
    begin_next();
    while (!(*job)->result) co_await (*job)->changed.wait(Clock::time_point::max());
    co_return *(*job)->result;
}

/// One that waits and is the same, or a new one in the line.
Outcome<std::shared_ptr<SnapshotDesk::Job>> SnapshotDesk::join(SnapshotQuery query) {
    const auto same = std::ranges::find_if(waiting_, [&](const auto& job) { return job->query == query; });
    if (same != waiting_.end()) return *same;
    if (waiting_.size() >= kMaxWaiting)
        return refuse(RefusalKind::busy, std::to_string(waiting_.size()) +
                                             " pictures of this wall wait to be made already: ask again later");
    return waiting_.emplace_back(std::make_shared<Job>(executor_, std::move(query)));
}

void SnapshotDesk::begin_next() {
    while (being_made_ < kAtOnce && !waiting_.empty()) {
        ++being_made_;
        auto job = std::move(waiting_.front());
        waiting_.pop_front();  // before it is made, which may come back here at once
        net::spawn(executor_, "picture", make(std::move(job)));
    }
}

asio::awaitable<void> SnapshotDesk::make(std::shared_ptr<Job> job) {
    std::string failure;
    try {
        job->result = co_await picture_of(job);
    } catch (const std::exception& error) {  // memory is short for a picture of that size
        failure = error.what();
    }
    if (!job->result) {
        log::error("picture_failed error={}", log::quoted(failure));
        job->result = refuse(RefusalKind::failed, "the picture cannot be made: " + failure);
    }
    std::erase_if(pending_, [&](const auto& entry) { return entry.second.job == job; });
    job->changed.notify();
    --being_made_;
    begin_next();
}

asio::awaitable<Outcome<Png>> SnapshotDesk::picture_of(const std::shared_ptr<Job>& job) {
    if (const auto asked = ask_nodes(job); !asked) co_return tl::unexpected(asked.error());
    while (job->missing > 0 && Clock::now() < job->heard + kLimit) co_await job->changed.wait(job->heard + kLimit);
    std::erase_if(pending_, [&](const auto& entry) { return entry.second.job == job; });
    if (job->missing > 0) log::warn("snapshot_incomplete tiles_missing={}", job->missing);
    auto png = co_await asio::co_spawn(composing_, compose(std::move(job->picture)), asio::use_awaitable);
    if (!png) co_return refuse(RefusalKind::conflict, png.error().message);
    co_return std::make_shared<const std::string>(std::move(*png));
}

Outcome<void> SnapshotDesk::ask_nodes(const std::shared_ptr<Job>& job) {
    const auto& query = job->query;
    job->heard = Clock::now();
    job->picture.view = wall_.config().canvas();
    job->picture.background = wall_.config().background;
    SessionId session;
    if (query.target) {
        const auto key = wall_.resolve(*query.target);
        if (!key) return tl::unexpected(key.error());
        session = key->session;
        job->picture.view = geom::intersect(job->picture.view, wall_.find(*key)->place.shown());
    }
    if (query.output && (query.tile.empty() || query.target))
        return refuse(RefusalKind::invalid,
                      "what an output shows is a picture of its own: expected a tile, and no program");
    bool found = false;
    for (const NodeIndex node : wall_.nodes().ids()) {
        for (const auto& tile : wall_.nodes()[node].config->tiles) {
            if (tile.arriving) continue;
            if (query.tile.empty() ? tile.eye == geom::Eye::right : tile.name != query.tile) continue;
            found = true;
            if (!query.tile.empty() && !wall_.nodes()[node].up)
                return refuse(RefusalKind::unavailable, "node " + wall_.nodes()[node].config->name +
                                                            ", which shows tile " + query.tile +
                                                            ", is away: `wallctl doctor` says more");
            const auto place = place_of(query, tile);
            if (!query.tile.empty())
                job->picture.view = query.target ? geom::intersect(job->picture.view, place) : place;
            if (!wall_.nodes()[node].up || !geom::overlaps(place, job->picture.view)) continue;
            job->picture.tiles.push_back({place, {}});
            ask(job, node, tile.slot, session);
        }
    }
    if (!found) return refuse(RefusalKind::not_found, "there is no tile '" + query.tile + "'");
    return {};
}

/// Where what the tile's node sends lies in the picture.
geom::Rect SnapshotDesk::place_of(const SnapshotQuery& query, const config::TileConfig& tile) {
    return query.output ? geom::Rect{0, 0, tile.output.width, tile.output.height} : tile.rect;
}

void SnapshotDesk::ask(const std::shared_ptr<Job>& job, NodeIndex node, std::uint32_t slot, SessionId session) {
    last_id_ = PictureId(last_id_.value + 1);
    proto::SnapshotRequest request;
    request.set_request(last_id_.value);
    request.set_slot(slot);
    request.set_session(session.value);
    request.set_output(job->query.output);
    pending_.emplace(last_id_, Pending{job, job->picture.tiles.size() - 1, node});
    ++job->missing;
    out_.to_node(node, walld::make(&proto::Envelope::mutable_snapshot_request, request));
}

void SnapshotDesk::arrived(NodeIndex node, proto::Snapshot& snapshot) {
    const auto found = pending_.find(PictureId(snapshot.request()));
    if (found == pending_.end() || found->second.node != node) return;
    Job& job = *found->second.job;
    TilePicture& tile = job.picture.tiles[found->second.tile];
    job.heard = Clock::now();
    job.changed.notify();
    const auto& name = wall_.nodes()[node].config->name;
    if (!snapshot.error().empty()) {
        log::warn("snapshot_failed node={} error={}", log::quoted(name), log::quoted(snapshot.error()));
        tile.rgb.clear();
    } else if (!tile.add(snapshot.width(), snapshot.height(), snapshot.offset(), snapshot.rgb())) {
        log::warn("snapshot_bad node={} width={} height={} offset={} bytes={}", log::quoted(name), snapshot.width(),
                  snapshot.height(), snapshot.offset(), snapshot.rgb().size());
        tile.rgb.clear();
    } else if (!tile.complete()) {
        return;
    }
    finish(found);
}

void SnapshotDesk::node_left(NodeIndex node) {
    for (auto at = pending_.begin(); at != pending_.end();) {
        const auto here = at++;
        if (here->second.node == node) finish(here);
    }
}

/// All of the tile is there, or nothing more of it will come.
void SnapshotDesk::finish(std::map<PictureId, Pending>::iterator pending) {
    const auto job = pending->second.job;
    pending_.erase(pending);
    --job->missing;
    job->changed.notify();
}

}  // namespace wall::walld
