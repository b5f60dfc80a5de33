// SPDX-License-Identifier: MIT
// The I/O side of a node's process: the listener for programs, and a node of the wall for each GPU that draws tiles of
// it. A program's ticket says which of them its stream is for. I/O thread.
//
//     programs ──► NodeServer (listener, handshakes, strangers) ──ticket──► GpuNode ◄──► walld
//                                                                  └─────► GpuNode ◄──► walld
#pragma once

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/wall_config.h"
#include "tileserver/io/data_stream.h"
#include "tileserver/io/gpu_node.h"
#include "tileserver/io/node_keys.h"

namespace wall::tileserver {

/// What one GPU draws.
struct GpuPart {
    config::NodeConfig node;
    const CompilerHost* compilers = nullptr;  ///< for trials of shaders; null: they are compiled without limits
};

class NodeServer final : private StreamDoor {
public:
    /// Opens the drivers and the listener; the error says what stands in the way. At least one part, all of one
    /// [[node]]; what they refer to outlives it.
    static Result<std::unique_ptr<NodeServer>> open(asio::any_io_executor executor, const config::WallConfig& wall,
                                                    const std::vector<GpuPart>& parts, NodeKeys keys = {},
                                                    const Described& described = {});
    ~NodeServer() override;

    /// Starts to accept programs and to look for walld.
    void start();
    /// Closes everything; the executor runs out of work soon.
    void stop();

    const net::Address& address() const { return listener_->address(); }
    /// When all render threads had last said something; each does about once a second.
    std::chrono::steady_clock::time_point last_sign_of_life() const;
    /// How long one turn of a stream may take, that is, one call of the driver; then its session is ended. Before
    /// start().
    void set_longest_turn(std::chrono::milliseconds limit);
    /// How many connections may be there that have shown no ticket; the oldest of more is closed. Before start().
    void set_most_strangers(std::size_t most) { most_strangers_ = most; }
    /// Why the process cannot go on; none: it can.
    std::optional<std::string> failure() const;
    /// It is described otherwise now.
    bool starts_anew() const;

private:
    static constexpr std::size_t kMaxHandshakes = 256;  ///< at the same time

    NodeServer(asio::any_io_executor executor, NodeKeys keys) : executor_(executor), keys_(std::move(keys)) {}

    // StreamDoor
    const std::vector<StreamHost*>& hosts() const override { return hosts_; }
    void known(StreamId stream) override { strangers_.erase(stream); }
    void gone(StreamId stream) override {
        strangers_.erase(stream);
        arriving_.erase(stream);
    }

    asio::awaitable<void> take_over_tls(net::StreamSocket socket);
    void take_program(net::Stream connection);
    void make_room_for_stranger();

    asio::any_io_executor executor_;
    NodeKeys keys_;
    std::optional<net::Listener> listener_;
    bool stopping_ = false;
    std::size_t handshakes_ = 0, most_strangers_ = 1024;
    std::uint32_t last_stream_ = 0;
    std::map<StreamId, std::shared_ptr<DataStream>> arriving_;  // until a node has them
    std::set<StreamId> strangers_;  // those of them that have shown no ticket and may still; ids grow
    std::vector<std::unique_ptr<GpuNode>> nodes_;
    std::vector<StreamHost*> hosts_;  // nodes_
};

}  // namespace wall::tileserver
