// SPDX-License-Identifier: MIT
#include "tools/wallctl/bandwidth.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>

#include "common/base/address.h"
#include "common/base/connect_within.h"
#include "common/base/unique_fd.h"
#include "common/net/control_client.h"
#include "common/wire/batch.h"
#include "common/wire/frame.h"
#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"

namespace wall::wallctl {
namespace {

using Clock = std::chrono::steady_clock;
namespace pack = glapi::pack;

constexpr std::chrono::milliseconds kProbeReach{2000}, kWelcome{10000};
constexpr std::chrono::milliseconds kSending{500};  // enough that a link's buffers are little of it
constexpr std::chrono::seconds kLongest{20};        // for what was sent to arrive, over a slow link
constexpr std::size_t kBuffer = std::size_t{1} << 20;
constexpr int kRoundTrips = 9;
constexpr std::uint32_t kStaticDraw = 0x88E4;  // GL_STATIC_DRAW

Result<void> failed(const char* what) {
    const bool slow = errno == EAGAIN || errno == EWOULDBLOCK;
    return fail(std::string(what) + ": " +
                (slow ? "nothing has moved for " + std::to_string(kLongest.count()) + " s" : std::strerror(errno)));
}

/// A program's stream to a node.
class Probe {
public:
    static Result<Probe> open(const std::string& address_text, const std::string& hello) {
        const auto address = Address::parse(address_text);
        if (!address) return tl::unexpected(address.error());
        const auto to = resolve(*address);
        if (!to) return tl::unexpected(to.error());
        Probe probe(UniqueFd(::socket(to->family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)));
        if (const int error = connect_within(probe.fd_.get(), to->get(), to->length, Clock::now() + kProbeReach);
            error != 0)
            return fail(address_text + ": " + std::strerror(error));
        probe.wait_at_most(kLongest);
        if (auto sent = probe.send(wire::whole_frame(wire::FrameKind::hello, std::as_bytes(std::span(hello)))); !sent)
            return tl::unexpected(sent.error());
        const auto answer = probe.receive();
        if (!answer) return tl::unexpected(answer.error());
        if (answer->kind == wire::FrameKind::welcome) return probe;
        return fail(std::string(reinterpret_cast<const char*>(answer->payload.data()), answer->payload.size()));
    }
    Result<void> send(const wire::PackBuffer& commands) {
        std::vector<std::byte> payload;
        wire::append_batch(payload, {ContextId(1), commands.opcodes(), commands.operands()});
        return send(wire::whole_frame(wire::FrameKind::batch, payload));
    }
    /// Waits until the node has done all that was sent.
    Result<void> sync() {
        wire::PackBuffer commands;
        pack::Sync(commands, RequestId(++requests_));
        if (auto sent = send(commands); !sent) return sent;
        for (;;) {
            const auto frame = receive();
            if (!frame) return tl::unexpected(frame.error());
            std::uint32_t answered = 0;
            if (frame->kind == wire::FrameKind::reply && frame->payload.size() >= sizeof answered)
                std::memcpy(&answered, frame->payload.data(), sizeof answered);
            if (answered == requests_) return {};
        }
    }

private:
    struct Frame {
        wire::FrameKind kind{};
        std::vector<std::byte> payload;
    };
    explicit Probe(UniqueFd fd) : fd_(std::move(fd)) {}

    void wait_at_most(std::chrono::seconds limit) {
        ::fcntl(fd_.get(), F_SETFL, ::fcntl(fd_.get(), F_GETFL) & ~O_NONBLOCK);
        const timeval time{limit.count(), 0};
        ::setsockopt(fd_.get(), SOL_SOCKET, SO_SNDTIMEO, &time, sizeof time);
        ::setsockopt(fd_.get(), SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
    }
    Result<void> send(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent <= 0) return failed("sending");
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        }
        return {};
    }
    Result<void> read(std::span<std::byte> to) {
        while (!to.empty()) {
            const ssize_t got = ::recv(fd_.get(), to.data(), to.size(), 0);
            if (got < 0 && errno == EINTR) continue;
            if (got == 0) return fail("the node has closed the stream");
            if (got < 0) return failed("waiting for the node");
            to = to.subspan(static_cast<std::size_t>(got));
        }
        return {};
    }
    Result<Frame> receive() {
        constexpr std::uint32_t kMostAnswer = 4096;
        std::array<std::byte, wire::kFrameHeaderBytes> head;
        if (auto got = read(head); !got) return tl::unexpected(got.error());
        const auto header = wire::decode_frame_header(head.data());
        if (header.payload_bytes > kMostAnswer) return fail("the node does not speak this protocol");
        Frame frame{header.kind, std::vector<std::byte>(header.payload_bytes)};
        if (auto got = read(frame.payload); !got) return tl::unexpected(got.error());
        if (header.kind != wire::FrameKind::error && header.kind != wire::FrameKind::unreachable) return frame;
        return fail(std::string(reinterpret_cast<const char*>(frame.payload.data()), frame.payload.size()));
    }

    UniqueFd fd_;
    std::uint32_t requests_ = 0;
};

Result<std::chrono::microseconds> round_trip(Probe& probe) {
    std::vector<Clock::duration> times;
    for (int i = 0; i < kRoundTrips; ++i) {
        const auto start = Clock::now();
        if (auto done = probe.sync(); !done) return tl::unexpected(done.error());
        times.push_back(Clock::now() - start);
    }
    std::ranges::nth_element(times, times.begin() + kRoundTrips / 2);
    return std::chrono::duration_cast<std::chrono::microseconds>(times[kRoundTrips / 2]);
}

Result<double> bytes_a_second(Probe& probe) {
    const std::vector<std::byte> content(kBuffer, std::byte{0x5a});
    wire::PackBuffer make, fill;
    pack::BufferData(make, ClientName(1), static_cast<std::uint32_t>(kBuffer), kStaticDraw);
    pack::BufferSubData(fill, ClientName(1), 0, content);
    if (auto sent = probe.send(make); !sent) return tl::unexpected(sent.error());
    if (auto done = probe.sync(); !done) return tl::unexpected(done.error());
    std::size_t bytes = 0;
    const auto start = Clock::now();
    for (; Clock::now() < start + kSending; bytes += content.size())
        if (auto sent = probe.send(fill); !sent) return tl::unexpected(sent.error());
    if (auto done = probe.sync(); !done) return tl::unexpected(done.error());
    return static_cast<double>(bytes) / std::chrono::duration<double>(Clock::now() - start).count();
}

Result<Way> measure(const proto::NodeUp& node, std::uint32_t session) {
    proto::DataHello hello;
    hello.set_version(glapi::kStreamVersion);
    hello.set_session(session);
    hello.set_ticket(node.ticket());
    auto probe = Probe::open(node.address(), hello.SerializeAsString());
    if (!probe) return tl::unexpected(probe.error());
    const auto time = round_trip(*probe);
    if (!time) return tl::unexpected(time.error());
    const auto speed = bytes_a_second(*probe);
    if (!speed) return tl::unexpected(speed.error());
    return Way{.bytes_a_second = *speed, .round_trip = *time};
}

Result<proto::ClientWelcome> come(net::ControlClient& client, const std::string& token) {
    proto::Envelope message;
    auto& hello = *message.mutable_client_hello();
    hello.set_version(wire::kProtocolVersion);
    hello.set_pid(static_cast<std::uint32_t>(::getpid()));
    hello.set_program("wallctl doctor");
    hello.set_token(token);
    if (auto sent = client.send(message); !sent) return tl::unexpected(sent.error());
    for (;;) {
        const auto answer = client.receive(kWelcome);
        if (!answer) return tl::unexpected(answer.error());
        if (answer->has_refused()) return fail(answer->refused().reason());
        if (answer->has_client_welcome()) return answer->client_welcome();
    }
}

}  // namespace

Result<void> measure_ways(const request::Walld& walld, const std::function<void(const Way&)>& measured) {
    const auto address = Address::parse(walld.address);
    if (!address) return tl::unexpected(address.error());
    const auto token = request::read_token(walld.token_file);
    if (!token) return fail(token.error().message);
    auto client = net::ControlClient::connect(*address, kProbeReach);
    if (!client) return tl::unexpected(client.error());
    const auto welcome = come(*client, *token);
    if (!welcome) return tl::unexpected(welcome.error());
    for (const auto& node : welcome->nodes()) {
        const auto found = measure(node, welcome->session());
        Way way = found ? *found : Way{.trouble = found.error().message};
        const auto tile = std::ranges::find(welcome->tiles(), node.node(), &proto::TileInfo::node);
        if (tile != welcome->tiles().end()) way.tile = tile->name();
        measured(way);
    }
    return {};
}

}  // namespace wall::wallctl
