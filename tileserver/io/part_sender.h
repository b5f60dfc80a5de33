// SPDX-License-Identifier: MIT
// Sends walld what may be large, pictures above all, in parts: one after the other, those of several in turn, and the
// next one when the link has taken what was queued. So a picture of any size passes, a frame's report never waits
// behind more than one part, and nothing piles up on the link. I/O thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "common/net/control_connection.h"
#include "proto/control.pb.h"
#include "tileserver/render/compositor.h"

namespace wall::tileserver {

namespace asio = boost::asio;

/// Gives the parts in order; nothing after the last.
using Parts = std::function<std::optional<proto::Envelope>()>;

/// What parts belong to. Those of one follow each other, however many pictures of it wait.
struct PartsOf {
    enum class Kind { snapshot, stream } kind;
    PictureId id;
    bool operator==(const PartsOf&) const = default;
};

/// A tile's picture as Snapshot messages.
Parts snapshot_parts(Picture picture);
/// A stream's frame, or its end; `head` is what its first message says. `keep` lives until the last part is gone.
Parts frame_parts(proto::StreamFrame head, std::vector<std::byte> packet, std::shared_ptr<const void> keep);

class PartSender {
public:
    explicit PartSender(asio::any_io_executor executor) : executor_(std::move(executor)) {}

    /// From now on to this link (null: to nobody). What waited for the one before is dropped.
    void use(std::shared_ptr<net::ControlConnection> link);
    void send(const PartsOf& of, Parts parts);

private:
    struct Waiting {
        PartsOf of;
        std::deque<Parts> parts;
    };
    struct Line {
        std::shared_ptr<net::ControlConnection> link;
        std::deque<Waiting> waiting;  // whose turn it is first
        bool running = false;
    };
    static asio::awaitable<void> run(std::shared_ptr<Line> line);

    asio::any_io_executor executor_;
    std::shared_ptr<Line> line_;  // null: no link
};

}  // namespace wall::tileserver
