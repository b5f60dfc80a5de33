// SPDX-License-Identifier: MIT
// Encodes the pictures of watched tiles on a thread of its own, which gives way to rendering. I/O thread; the encoders
// belong to the pool, and at most one picture of a stream is there at a time.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>

#include "proto/control.pb.h"
#include "tileserver/io/part_sender.h"
#include "tileserver/render/render_thread.h"

namespace wall::tileserver {

namespace asio = boost::asio;

class TileStreams {
public:
    /// `send`: what is of a stream, to walld; called on the executor.
    TileStreams(asio::any_io_executor executor, std::function<void(PictureId stream, Parts)> send)
        : executor_(std::move(executor)), send_(std::move(send)) {}
    /// Waits for the pictures that are being encoded.
    ~TileStreams() { pool_.join(); }

    void start(RenderThread& render, const proto::StreamStart& message);
    void stop(RenderThread& render, PictureId stream);
    void stop_all(RenderThread& render);
    void ready(RenderThread& render, const proto::StreamReady& message);
    /// A picture of a stream. Any executor thread but the pool's.
    void picture(Picture picture);
    /// What every stream has cost since it was started.
    void fill_stats(proto::NodeStats& out) const;

private:
    struct Stream;
    struct Made;
    static Made make(Stream& stream, PictureId id, bool key, const Picture& picture);
    void deliver(const std::shared_ptr<Stream>& stream, Made made);
    void fail(PictureId stream, const std::string& why);

    asio::any_io_executor executor_;
    std::function<void(PictureId stream, Parts)> send_;
    std::map<PictureId, std::shared_ptr<Stream>> streams_;
    asio::thread_pool pool_{1};
};

}  // namespace wall::tileserver
