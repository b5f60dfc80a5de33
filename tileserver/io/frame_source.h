// SPDX-License-Identifier: MIT
// Where the frames of a data stream come from: its socket, or a ring of shared memory (common/wire/ring.h) that its
// writer has sent along with its first bytes; then the socket says no more than that there is something in the ring.
// One executor, one thread.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <functional>
#include <optional>

#include "common/base/raw_bytes.h"
#include "common/base/unique_fd.h"
#include "common/net/stream.h"
#include "common/wire/frame_reader.h"
#include "common/wire/ring.h"

namespace wall::tileserver {

namespace asio = boost::asio;

class FrameSource {
public:
    static constexpr const char* kClosed = "closed";  ///< the error of an orderly end

    /// `on_bytes` hears of all that comes.
    FrameSource(net::Stream& connection, std::uint32_t limit, std::function<void(std::size_t)> on_bytes)
        : connection_(connection), reader_(limit), on_bytes_(std::move(on_bytes)) {}

    /// The next frame, or why there is none.
    asio::awaitable<Result<wire::Frame>> next();

    /// False: the writer has sent no ring. Else frames come through it from now on, and `tell_room` is called when the
    /// writer waits for room there that it has now.
    Result<bool> take_ring(std::function<void()> tell_room);
    /// What has ended it was the connection, and not what came over it.
    bool connection_lost() const { return lost_; }
    /// The connection is another one, on which frames come from that on which has not come whole.
    void go_on();
    std::uint64_t batch_frames() const { return reader_.batch_frames(); }
    bool has_ring() const { return ring_.has_value(); }
    void set_limits(std::uint32_t frame, std::uint32_t batch) { reader_.set_limits(frame, batch); }
    /// Memory that the next payload may go to.
    void lend(RawBytes memory) { reader_.lend(std::move(memory)); }
    void forget_lent() { reader_.forget_lent(); }

private:
    static constexpr std::size_t kMostAtOnce = 1 << 20;  // bytes, after which others on this thread have their turn

    asio::awaitable<Result<void>> read_socket();
    asio::awaitable<Result<void>> read_ring();

    net::Stream& connection_;
    wire::FrameReader reader_;
    std::function<void(std::size_t)> on_bytes_;
    UniqueFd descriptor_;  // that came with the first bytes
    bool first_ = true, lost_ = false;
    std::optional<wire::RingReader> ring_;
    std::function<void()> tell_room_;
    std::optional<Error> ended_;  // of the socket; there may be more in the ring
    std::size_t at_once_ = 0;     // bytes since others had their turn
};

}  // namespace wall::tileserver
