// SPDX-License-Identifier: MIT
// The wall's picture kept up to date: tiles watched through walld (docs/streams.md), decoded on a thread of its own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "common/codec/codec.h"
#include "common/geom/rect.h"
#include "common/net/control_client.h"
#include "tools/wallctl/verbs.h"

namespace wall::wallctl {

class LiveWall {
public:
    /// `tile`: only that; empty: all. `fps`: at most so many pictures a second of each tile.
    static Outcome<std::unique_ptr<LiveWall>> open(const Walld& walld, const std::string& tile, unsigned fps);
    ~LiveWall();

    std::uint32_t width() const { return format_.width; }
    std::uint32_t height() const { return format_.height; }
    /// Waits until every tile whose node is up has shown a picture; false if that takes longer.
    bool wait_complete(std::chrono::milliseconds limit);
    /// The newest picture, RGBA. The error says why there will be no more.
    Outcome<codec::Picture> picture();

private:
    struct Tile {
        std::string name;
        geom::Rect rect;  ///< in the picture
        bool expected = false, shown = false;
        codec::StreamFormat format;
        std::unique_ptr<codec::Decoder> decoder;
    };
    LiveWall(net::ControlClient client, std::vector<Tile> tiles, codec::StreamFormat format, std::uint32_t background);
    void receive();
    Result<void> take(const proto::OperatorReply& reply);
    Result<void> take_text(const nlohmann::json& text);
    Result<void> take_frame(std::string_view frame);
    void paint(const geom::Rect& rect, const codec::FrameView* frame);

    net::ControlClient client_;
    std::vector<Tile> tiles_;
    codec::StreamFormat format_;
    std::uint32_t background_;  ///< 0xRRGGBB
    std::mutex mutex_;          // guards the next three, and Tile::shown
    std::condition_variable changed_;
    codec::Picture picture_;
    std::string failure_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

}  // namespace wall::wallctl
