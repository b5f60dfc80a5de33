// SPDX-License-Identifier: MIT
#include "tileserver/io/frame_source.h"

#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace wall::tileserver {
namespace {

constexpr std::size_t kSigns = 64;  // bytes; each says that there is something in the ring

Error error_of(const boost::system::error_code& error) {
    return {error == asio::error::eof ? FrameSource::kClosed : error.message()};
}

}  // namespace

asio::awaitable<Result<wire::Frame>> FrameSource::next() {
    for (;;) {
        auto frame = reader_.next();
        if (!frame) co_return tl::unexpected(frame.error());
        if (*frame) co_return std::move(**frame);
        Result<void> read;
        if (ring_) read = co_await read_ring();
        else read = co_await read_socket();
        if (!read) co_return tl::unexpected(read.error());
    }
}

asio::awaitable<Result<void>> FrameSource::read_socket() {
    const auto room = reader_.prepare();
    const asio::mutable_buffer to(room.data(), room.size());
    net::Stream::Transferred came;
    if (std::exchange(first_, false)) came = co_await connection_.read_some_with(to, descriptor_);
    else came = co_await connection_.read_some(to);
    const auto [error, bytes] = came;
    lost_ = static_cast<bool>(error);
    if (error) co_return tl::unexpected(error_of(error));
    reader_.commit(bytes);
    on_bytes_(bytes);
    co_return Result<void>{};
}

/// Some bytes, or a sign that there are. What was written before the socket's end is still read.
asio::awaitable<Result<void>> FrameSource::read_ring() {
    if (at_once_ >= kMostAtOnce) {
        at_once_ = 0;
        co_await asio::post(connection_.executor(), asio::use_awaitable);
    }
    const auto bytes = ring_->read(reader_.prepare());
    if (!bytes) co_return tl::unexpected(bytes.error());
    reader_.commit(*bytes);
    at_once_ += *bytes;
    if (*bytes != 0) {
        on_bytes_(*bytes);
        if (ring_->writer_waits()) tell_room_();
        co_return Result<void>{};
    }
    if (ended_) co_return tl::unexpected(*ended_);
    if (!ring_->wait_for_more()) co_return Result<void>{};
    at_once_ = 0;
    std::array<std::byte, kSigns> signs;
    const auto [error, came] = co_await connection_.read_some(asio::buffer(signs));
    if (error) ended_ = error_of(error);
    co_return Result<void>{};
}

void FrameSource::go_on() {
    reader_.begin_frame_again();
    lost_ = false;
}

Result<bool> FrameSource::take_ring(std::function<void()> tell_room) {
    if (!descriptor_) return false;
    auto ring = wire::RingReader::open(std::exchange(descriptor_, {}));
    if (!ring) return tl::unexpected(ring.error());
    ring_.emplace(std::move(*ring));
    tell_room_ = std::move(tell_room);
    return true;
}

}  // namespace wall::tileserver
