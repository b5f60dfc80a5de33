// SPDX-License-Identifier: MIT
// A node that a test plays: what it receives is looked at, and nothing is drawn.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/unique_fd.h"
#include "common/wire/batch.h"
#include "common/wire/frame.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using wire::FrameKind;

inline constexpr auto kPatience = 10s;

inline bool readable(int fd, std::chrono::milliseconds limit) {
    pollfd wait{fd, POLLIN, 0};
    return ::poll(&wait, 1, static_cast<int>(limit.count())) > 0;
}

/// A socket that listens at a path of its own.
class Listener {
public:
    explicit Listener(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / ("wallgl_" + name + std::to_string(getpid()))) {
        std::filesystem::remove(path_);
        fd_ = UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path_.string().copy(address.sun_path, sizeof address.sun_path - 1);
        EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        EXPECT_EQ(::listen(fd_.get(), 8), 0);
    }
    ~Listener() { std::filesystem::remove(path_); }
    std::string address() const { return "unix:" + path_.string(); }
    /// Nothing if nobody comes in time.
    UniqueFd accept(std::chrono::milliseconds limit = kPatience) {
        return UniqueFd(readable(fd_.get(), limit) ? ::accept(fd_.get(), nullptr, nullptr) : -1);
    }

private:
    std::filesystem::path path_;
    UniqueFd fd_;
};

/// A node that the test plays.
struct FakeNode {
    struct Frame {
        FrameKind kind{};
        std::vector<std::byte> payload;
    };
    explicit FakeNode(const std::string& name) : listener(name) {}

    /// A client comes and is welcomed, while `meanwhile` is called again and again. `number`: of its stream, four
    /// bytes; none: it is of this machine, and ends with its connection.
    template <class Call>
    bool welcome(Call&& meanwhile, std::chrono::milliseconds limit = kPatience, const std::string& number = "") {
        for (const auto end = Clock::now() + limit; !stream && Clock::now() < end; meanwhile())
            stream = listener.accept(20ms);
        if (!stream || receive().kind != FrameKind::hello) return false;
        send(FrameKind::welcome, number);
        return true;
    }
    void send(FrameKind kind, const std::string& text) {
        const auto header = wire::encode_frame_header({static_cast<std::uint32_t>(text.size()), kind});
        EXPECT_EQ(::send(stream.get(), header.data(), header.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(header.size()));
        EXPECT_EQ(::send(stream.get(), text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
    }
    Frame receive() {
        std::array<std::byte, wire::kFrameHeaderBytes> head;
        if (!readable(stream.get(), kPatience) ||
            ::recv(stream.get(), head.data(), head.size(), MSG_WAITALL) != static_cast<ssize_t>(head.size()))
            return {};
        const auto header = wire::decode_frame_header(head.data());
        Frame frame{header.kind, std::vector<std::byte>(header.payload_bytes)};
        if (header.payload_bytes != 0) ::recv(stream.get(), frame.payload.data(), frame.payload.size(), MSG_WAITALL);
        return frame;
    }
    /// Whether the next batch has such a command.
    bool receives(glapi::Op op) {
        const Frame frame = receive();
        if (frame.kind != FrameKind::batch) return false;
        const auto batch = wire::split_batch(frame.payload);
        return batch && std::ranges::count(batch->opcodes, static_cast<std::byte>(op)) > 0;
    }

    Listener listener;
    UniqueFd stream;
};

}  // namespace wall::client
