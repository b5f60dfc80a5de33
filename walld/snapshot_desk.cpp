// SPDX-License-Identifier: MIT
#include "walld/snapshot_desk.h"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "walld/messages.h"

namespace wall::walld {
namespace {

asio::awaitable<Result<std::string>> compose(PictureJob job) { co_return compose_png(job); }

}  // namespace

asio::awaitable<Outcome<std::string>> SnapshotDesk::take(SnapshotQuery query) {
    auto started = start(query);
    if (!started) co_return tl::unexpected(started.error());
    const auto job = *started;
    const auto until = Clock::now() + kLimit;
    while (job->missing > 0 && Clock::now() < until) co_await job->done.wait(until);
    std::erase_if(pending_, [&](const auto& entry) { return entry.second.job == job; });
    if (job->missing > 0) spdlog::warn("snapshot_incomplete tiles_missing={}", job->missing);
    auto png = co_await asio::co_spawn(composing_, compose(std::move(job->picture)), asio::use_awaitable);
    if (!png) co_return refuse(RefusalKind::conflict, png.error().message);
    co_return std::move(*png);
}

Outcome<std::shared_ptr<SnapshotDesk::Job>> SnapshotDesk::start(const SnapshotQuery& query) {
    auto job = std::make_shared<Job>(executor_);
    job->picture.view = wall_.config().canvas();
    job->picture.background = wall_.config().background;
    SessionId session;
    if (query.target) {
        const auto key = wall_.resolve(*query.target);
        if (!key) return tl::unexpected(key.error());
        session = key->session;
        job->picture.view = geom::intersect(job->picture.view, wall_.find(*key)->place.shown());
    }
    bool found = false;
    for (NodeIndex node = 0; node < wall_.nodes().size(); ++node) {
        for (std::uint32_t slot = 0; const auto& tile : wall_.nodes()[node].config->tiles) {
            const auto this_slot = slot++;
            if (!query.tile.empty() && tile.name != query.tile) continue;
            found = true;
            if (!query.tile.empty())
                job->picture.view = query.target ? geom::intersect(job->picture.view, tile.rect) : tile.rect;
            if (!wall_.nodes()[node].up || !geom::overlaps(tile.rect, job->picture.view)) continue;
            job->picture.tiles.push_back({tile.rect, {}});
            ask(job, node, this_slot, session);
        }
    }
    if (!found) return refuse(RefusalKind::not_found, "there is no tile '" + query.tile + "'");
    return job;
}

void SnapshotDesk::ask(const std::shared_ptr<Job>& job, NodeIndex node, std::uint32_t slot, SessionId session) {
    proto::SnapshotRequest request;
    request.set_request(++last_request_);
    request.set_slot(slot);
    request.set_session(session.value);
    pending_.emplace(last_request_, Pending{job, job->picture.tiles.size() - 1, node});
    ++job->missing;
    out_.to_node(node, make(&proto::Envelope::mutable_snapshot_request, request));
}

void SnapshotDesk::arrived(NodeIndex node, proto::Snapshot& snapshot) {
    const auto found = pending_.find(snapshot.request());
    if (found == pending_.end() || found->second.node != node) return;
    auto& tile = found->second.job->picture.tiles[found->second.tile];
    const auto width = static_cast<std::uint32_t>(tile.rect.width),
               height = static_cast<std::uint32_t>(tile.rect.height);
    if (!snapshot.error().empty()) {
        spdlog::warn("snapshot_failed node={} error=\"{}\"", wall_.nodes()[node].config->name, snapshot.error());
    } else if (snapshot.width() != width || snapshot.height() != height ||
               snapshot.rgb().size() != std::size_t{width} * height * 3) {
        spdlog::warn("snapshot_bad node={} width={} height={} bytes={}", wall_.nodes()[node].config->name,
                     snapshot.width(), snapshot.height(), snapshot.rgb().size());
    } else {
        tile.rgb = std::move(*snapshot.mutable_rgb());
    }
    finish(found);
}

void SnapshotDesk::node_left(NodeIndex node) {
    for (auto at = pending_.begin(); at != pending_.end();) {
        const auto here = at++;
        if (here->second.node == node) finish(here);
    }
}

void SnapshotDesk::finish(std::map<std::uint32_t, Pending>::iterator pending) {
    const auto job = pending->second.job;
    pending_.erase(pending);
    if (--job->missing == 0) job->done.notify();
}

}  // namespace wall::walld
