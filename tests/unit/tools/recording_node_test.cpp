// SPDX-License-Identifier: MIT
// A program's stream to a node that records, by the program's own end of it.
#include "tools/wallctl/recording_node.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <filesystem>

#include "common/base/address.h"
#include "common/glapi/gl_types.h"
#include "common/wire/frame.h"
#include "gen/glapi/wire.gen.h"
#include "proto/control.pb.h"

namespace wall::wallctl {
namespace {

using namespace std::chrono_literals;
using wire::FrameKind;

constexpr auto kPatience = 10s;

class ANodeThatRecords : public testing::Test {
protected:
    void SetUp() override {
        auto made = RecordingNode::listen({.begins = [this]() -> Result<void> {
                                               ++begun;
                                               return {};
                                           },
                                           .batch =
                                               [this](std::span<const std::byte> payload) {
                                                   batches.emplace_back(payload.begin(), payload.end());
                                                   return Result<std::vector<std::byte>>(answer);
                                               }});
        ASSERT_TRUE(made) << made.error().message;
        node.emplace(std::move(*made));
        node->expect("secret");
    }
    UniqueFd connect() const {
        const auto address = Address::parse(node->address()).and_then(&resolve);
        UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
        EXPECT_EQ(::connect(fd.get(), address->get(), address->length), 0);
        return fd;
    }
    static void send(const UniqueFd& fd, FrameKind kind, std::span<const std::byte> payload) {
        const auto frame = wire::whole_frame(kind, payload);
        EXPECT_EQ(::send(fd.get(), frame.data(), frame.size(), MSG_NOSIGNAL), static_cast<ssize_t>(frame.size()));
    }
    static void greet(const UniqueFd& fd, const std::string& ticket, std::uint32_t version = glapi::kStreamVersion) {
        proto::DataHello hello;
        hello.set_version(version);
        hello.set_session(1);
        hello.set_ticket(ticket);
        const auto text = hello.SerializeAsString();
        send(fd, FrameKind::hello, std::as_bytes(std::span(text)));
    }
    template <class Done>
    bool serve_until(Done&& done) {
        for (const auto end = std::chrono::steady_clock::now() + kPatience; !done();) {
            EXPECT_TRUE(node->serve(10ms));
            if (std::chrono::steady_clock::now() > end) return false;
        }
        return true;
    }
    /// What the node says next; nothing: it has closed the stream.
    std::optional<FrameKind> hear(const UniqueFd& fd) {
        std::array<std::byte, wire::kFrameHeaderBytes> head;
        ssize_t got = -1;
        serve_until([&] {
            got = ::recv(fd.get(), head.data(), head.size(), MSG_DONTWAIT);
            return got >= 0;
        });
        if (got != static_cast<ssize_t>(head.size())) return std::nullopt;
        const auto header = wire::decode_frame_header(head.data());
        std::vector<std::byte> payload(header.payload_bytes);
        if (!payload.empty() && ::recv(fd.get(), payload.data(), payload.size(), MSG_WAITALL) <= 0) return std::nullopt;
        return header.kind;
    }

    std::optional<RecordingNode> node;
    int begun = 0;
    std::vector<std::vector<std::byte>> batches;
    std::vector<std::byte> answer;
};

TEST_F(ANodeThatRecords, HandsOnWhatAProgramSends) {
    const UniqueFd program = connect();
    greet(program, "secret");
    EXPECT_EQ(hear(program), FrameKind::welcome);
    EXPECT_EQ(begun, 1);
    EXPECT_TRUE(node->has_stream());
    const std::vector<std::byte> payload(20, std::byte{7});
    answer = wire::whole_frame(FrameKind::swap_done, std::vector<std::byte>(8));
    send(program, FrameKind::part, payload);
    send(program, FrameKind::batch, payload);
    EXPECT_EQ(hear(program), FrameKind::swap_done);
    ASSERT_EQ(batches.size(), 1u);
    EXPECT_EQ(batches[0].size(), 40u) << "parts are one batch";
    node->ask_to_begin_again();
    EXPECT_EQ(hear(program), FrameKind::begin_again);
}

TEST_F(ANodeThatRecords, SendsStrangersAway) {
    for (const auto& [ticket, version] :
         {std::pair{"guess", glapi::kStreamVersion}, {"secret", glapi::kStreamVersion + 1}, {"", 0u}}) {
        const UniqueFd stranger = connect();
        greet(stranger, ticket, version);
        EXPECT_EQ(hear(stranger), FrameKind::error);
        EXPECT_EQ(hear(stranger), std::nullopt);
    }
    const UniqueFd rude = connect();
    send(rude, FrameKind::batch, {});
    EXPECT_EQ(hear(rude), std::nullopt);
    EXPECT_EQ(begun, 0);
    EXPECT_TRUE(batches.empty());
}

TEST_F(ANodeThatRecords, TakesAProgramThatComesAgain) {
    const UniqueFd first = connect();
    greet(first, "secret");
    EXPECT_EQ(hear(first), FrameKind::welcome);
    const UniqueFd second = connect();
    greet(second, "secret");
    EXPECT_EQ(hear(second), FrameKind::welcome);
    EXPECT_EQ(begun, 2) << "it is told from nothing";
    EXPECT_EQ(hear(first), std::nullopt);
    EXPECT_TRUE(node->has_stream());
}

TEST_F(ANodeThatRecords, LeavesNothingBehind) {
    const std::filesystem::path socket = node->address().substr(std::string("unix:").size());
    EXPECT_TRUE(std::filesystem::exists(socket));
    node.reset();
    EXPECT_FALSE(std::filesystem::exists(socket.parent_path()));
}

}  // namespace
}  // namespace wall::wallctl
