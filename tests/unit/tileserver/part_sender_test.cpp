// SPDX-License-Identifier: MIT
#include "tileserver/io/part_sender.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>

#include "common/wire/limits.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

Picture picture(std::uint32_t width, std::uint32_t height, std::uint32_t request) {
    Picture out;
    out.request.id = PictureId(request);
    out.width = width;
    out.height = height;
    out.rgba.resize(std::size_t{4} * width * height);
    for (std::size_t i = 0; i < out.rgba.size(); ++i) out.rgba[i] = static_cast<std::byte>(i % 251);
    return out;
}

std::vector<proto::Envelope> all(Parts parts) {
    std::vector<proto::Envelope> out;
    while (auto part = parts()) out.push_back(std::move(*part));
    return out;
}

TEST(Parts, OfALargeTileFitIntoMessages) {
    // More than a message may have, and than fits into whole parts.
    const auto large = picture(5003, 4999, 3);
    const auto parts = all(snapshot_parts(large));
    EXPECT_GT(std::size_t{3} * 5003 * 4999, wire::kMaxControlMessage);
    std::string rgb;
    for (const auto& part : parts) {
        const auto& snapshot = part.snapshot();
        EXPECT_TRUE(net::frame(part));
        EXPECT_LE(snapshot.rgb().size(), wire::kControlPart);
        EXPECT_EQ(snapshot.offset(), rgb.size());
        EXPECT_EQ(snapshot.request(), 3u);
        EXPECT_EQ(snapshot.width(), 5003u);
        EXPECT_EQ(snapshot.height(), 4999u);
        rgb += snapshot.rgb();
    }
    ASSERT_EQ(rgb.size(), std::size_t{3} * 5003 * 4999);
    for (std::size_t pixel = 0; pixel < rgb.size() / 3; ++pixel)
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_EQ(static_cast<std::byte>(rgb[3 * pixel + c]), large.rgba[4 * pixel + c]) << pixel;
}

TEST(Parts, OfAPictureThatIsNoneSayWhy) {
    Picture none;
    none.request.id = PictureId(4);
    none.error = "no such tile";
    const auto parts = all(snapshot_parts(none));
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].snapshot().error(), "no such tile");
}

TEST(Parts, OfAFrameSayWhatItIsOnce) {
    proto::StreamFrame head;
    head.set_stream(9);
    head.set_key(true);
    head.set_width(7680);
    head.set_header("h");
    auto held = std::make_shared<int>(1);
    const std::weak_ptr<int> still = held;
    {
        auto parts =
            frame_parts(head, std::vector<std::byte>(2 * wire::kControlPart + 1, std::byte{7}), std::move(held));
        const auto messages = all(parts);
        ASSERT_EQ(messages.size(), 3u);
        std::uint64_t offset = 0;
        for (const auto& message : messages) {
            const auto& frame = message.stream_frame();
            EXPECT_EQ(frame.stream(), 9u);
            EXPECT_EQ(frame.offset(), offset);
            EXPECT_EQ(frame.packet_bytes(), 2 * wire::kControlPart + 1);
            EXPECT_EQ(frame.width(), offset == 0 ? 7680u : 0u);
            offset += frame.packet().size();
        }
        EXPECT_EQ(offset, 2 * wire::kControlPart + 1);
        EXPECT_FALSE(still.expired());
    }
    EXPECT_TRUE(still.expired());
    EXPECT_EQ(all(frame_parts(head, {}, nullptr)).size(), 1u);
}

/// A link to a walld that reads when the test does.
class PartSenderTest : public ::testing::Test {
protected:
    void SetUp() override {
        int ends[2];
        ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
        const net::asio::generic::stream_protocol unix_socket(AF_UNIX, 0);
        link_ = std::make_shared<net::ControlConnection>(net::Stream(net::StreamSocket(io_, unix_socket, ends[0])));
        walld_ = std::make_shared<net::ControlConnection>(net::Stream(net::StreamSocket(io_, unix_socket, ends[1])));
        sender_.use(link_);
    }
    void go_on() {
        io_.restart();
        io_.poll();
    }
    /// Reads on walld's side until `done` says so.
    void read(std::function<bool(const proto::Envelope&)> done) {
        bool over = false;
        net::asio::co_spawn(
            io_,
            [&]() -> net::asio::awaitable<void> {
                for (;;) {
                    const auto message = co_await walld_->receive();
                    if (!message || done(*message)) break;
                }
                over = true;
            },
            net::asio::detached);
        for (const auto until = std::chrono::steady_clock::now() + 20s;
             !over && std::chrono::steady_clock::now() < until;) {
            io_.restart();
            io_.run_for(10ms);
        }
        EXPECT_TRUE(over);
    }
    static PartsOf snapshot(std::uint32_t request) { return {PartsOf::Kind::snapshot, PictureId(request)}; }
    static proto::Envelope rendered(std::uint32_t frame) {
        proto::Envelope out;
        out.mutable_rendered()->set_frame(frame);
        return out;
    }

    net::asio::io_context io_;
    std::shared_ptr<net::ControlConnection> link_, walld_;
    PartSender sender_{io_.get_executor()};
};

TEST_F(PartSenderTest, AFramesReportDoesNotWaitBehindPictures) {
    for (std::uint32_t i = 0; i < 50; ++i) sender_.send(snapshot(i), snapshot_parts(picture(2048, 2048, i)));
    go_on();
    link_->send(rendered(1));
    std::size_t before = 0;
    read([&](const auto& message) { return message.has_rendered() || (++before, false); });
    EXPECT_LE(before, 2u) << "of 600 parts";
    EXPECT_TRUE(link_->is_open()) << "600 MB do not wait in its queue";
}

TEST_F(PartSenderTest, PicturesTakeTurns) {
    sender_.send(snapshot(1), snapshot_parts(picture(4096, 4096, 1)));
    sender_.send(snapshot(2), snapshot_parts(picture(16, 16, 2)));
    std::size_t before = 0;
    read([&](const auto& message) { return message.snapshot().request() == 2 || (++before, false); });
    EXPECT_LE(before, 2u);
}

TEST_F(PartSenderTest, FramesOfAStreamFollowEachOther) {
    // A viewer that comes in the middle of a frame makes its node take another one at once.
    for (std::uint64_t time = 1; time <= 2; ++time) {
        proto::StreamFrame head;
        head.set_stream(7);
        head.set_time_us(time);
        sender_.send({PartsOf::Kind::stream, PictureId(7)},
                     frame_parts(head, std::vector<std::byte>(5 << 20), nullptr));
    }
    sender_.send({PartsOf::Kind::stream, PictureId(8)}, frame_parts({}, std::vector<std::byte>(5 << 20), nullptr));
    std::vector<std::uint64_t> offsets;
    read([&](const auto& message) {
        if (message.stream_frame().stream() == 7) offsets.push_back(message.stream_frame().offset() >> 20);
        return offsets.size() == 10;
    });
    EXPECT_EQ(offsets, (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 0, 1, 2, 3, 4}));
}

TEST_F(PartSenderTest, WhatWaitedForALostLinkIsDropped) {
    const auto budget = std::make_shared<int>(1);
    const std::weak_ptr<int> held = budget;
    sender_.send({PartsOf::Kind::stream, PictureId(1)}, frame_parts({}, std::vector<std::byte>(100 << 20), budget));
    go_on();
    EXPECT_GT(held.use_count(), 1);
    link_->close();
    sender_.use(nullptr);
    io_.restart();
    io_.run_for(100ms);
    EXPECT_EQ(held.use_count(), 1);
    sender_.send(snapshot(1), snapshot_parts(picture(16, 16, 1)));  // to nobody
}

}  // namespace
}  // namespace wall::tileserver
