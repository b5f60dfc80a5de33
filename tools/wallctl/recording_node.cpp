// SPDX-License-Identifier: MIT
#include "tools/wallctl/recording_node.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "common/base/address.h"
#include "common/tls/secret.h"
#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"
#include "proto/control.pb.h"

namespace wall::wallctl {
namespace {

constexpr std::uint32_t kMaxHello = 4 << 10;  // bytes
constexpr std::size_t kMostPeers = 8;         // with those that have not said who they are
constexpr int kBacklog = 8;
constexpr std::size_t kReadsInARow = 16;          // of one, before the others have their turn
constexpr timeval kSendLimit{5, 0};               // a program reads what nodes say at any time
constexpr mode_t kFolder = 0711, kSocket = 0666;  // programs of any user come; the ticket says which

tl::unexpected<Error> system_error(const std::string& what) { return fail(what + ": " + std::strerror(errno)); }

}  // namespace

RecordingNode::RecordingNode(UniqueFd listener, std::filesystem::path folder, Events events)
    : listener_(std::move(listener)),
      folder_(std::move(folder)),
      address_("unix:" + (folder_ / "data").string()),
      events_(std::move(events)) {}

RecordingNode::~RecordingNode() {
    if (!listener_) return;
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
}

Result<RecordingNode> RecordingNode::listen(Events events) {
    std::string name = (std::filesystem::temp_directory_path() / "wallctl-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr || ::chmod(name.c_str(), kFolder) != 0)
        return system_error("cannot make a folder for a socket");
    UniqueFd listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    RecordingNode node(std::move(listener), name, std::move(events));
    const auto address = Address::parse(node.address_).and_then(&resolve);
    if (!address) return tl::unexpected(address.error());
    const auto path = std::filesystem::path(name) / "data";
    if (::bind(node.listener_.get(), address->get(), address->length) != 0 || ::chmod(path.c_str(), kSocket) != 0 ||
        ::listen(node.listener_.get(), kBacklog) != 0)
        return system_error("cannot listen at " + node.address_);
    return node;
}

bool RecordingNode::has_stream() const { return std::ranges::any_of(peers_, &Peer::greeted); }

Result<void> RecordingNode::serve(std::chrono::milliseconds limit) {
    std::vector<pollfd> waits{{listener_.get(), POLLIN, 0}};
    for (const Peer& peer : peers_) waits.push_back({peer.fd.get(), POLLIN, 0});
    if (::poll(waits.data(), waits.size(), static_cast<int>(limit.count())) <= 0) return {};
    std::vector<int> over;
    for (std::size_t i = 1; i < waits.size(); ++i) {
        if (waits[i].revents == 0) continue;
        const auto peer = std::ranges::find(peers_, waits[i].fd, [](const Peer& p) { return p.fd.get(); });
        const auto goes_on = read(*peer);
        if (!goes_on) return tl::unexpected(goes_on.error());
        if (!*goes_on) over.push_back(waits[i].fd);
    }
    std::erase_if(peers_, [&](const Peer& peer) { return std::ranges::count(over, peer.fd.get()) > 0; });
    if (waits.front().revents != 0) accept();
    return {};
}

void RecordingNode::accept() {
    UniqueFd fd(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!fd || peers_.size() >= kMostPeers) return;
    ::setsockopt(fd.get(), SOL_SOCKET, SO_SNDTIMEO, &kSendLimit, sizeof kSendLimit);
    peers_.push_back({std::move(fd), wire::FrameReader(kMaxHello)});
}

Result<bool> RecordingNode::read(Peer& peer) {
    for (std::size_t i = 0; i < kReadsInARow; ++i) {
        const auto room = peer.reader.prepare();
        const ssize_t n = ::recv(peer.fd.get(), room.data(), room.size(), MSG_DONTWAIT);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno == EAGAIN) return true;
        if (n <= 0) return false;
        peer.reader.commit(static_cast<std::size_t>(n));
        for (;;) {
            const auto frame = peer.reader.next();
            if (!frame) return false;
            if (!*frame) break;
            const auto goes_on = take(peer, **frame);
            if (!goes_on || !*goes_on) return goes_on;
        }
    }
    return true;
}

Result<bool> RecordingNode::take(Peer& peer, const wire::Frame& frame) {
    if (!peer.greeted) {
        if (frame.kind != wire::FrameKind::hello || !greet(peer, frame.payload)) return false;
        if (auto begun = events_.begins(); !begun) return tl::unexpected(begun.error());
        return true;
    }
    if (frame.kind == wire::FrameKind::receipt) return true;
    if (frame.kind != wire::FrameKind::batch) return false;
    const auto answer = events_.batch(frame.payload);
    if (!answer) return tl::unexpected(answer.error());
    return send(peer, *answer);
}

/// A later stream takes the place of an earlier one, of which the program knows no more.
bool RecordingNode::greet(Peer& peer, std::span<const std::byte> bytes) {
    proto::DataHello hello;
    const bool right = hello.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())) &&
                       hello.version() == glapi::kStreamVersion && !ticket_.empty() &&
                       tls::same_secret(hello.ticket(), ticket_);
    if (!right) {
        constexpr std::string_view kNo = "no valid ticket, or the program's WallGL library is of another version";
        send(peer, wire::whole_frame(wire::FrameKind::error, std::as_bytes(std::span(kNo))));
        return false;
    }
    for (Peer& other : peers_) {
        if (other.greeted) ::shutdown(other.fd.get(), SHUT_RDWR);
        other.greeted = false;
    }
    peer.greeted = true;
    peer.reader.set_limits(wire::kMaxFramePayload, wire::kMaxBatchPayload);
    const std::uint32_t ends_with_connection = 0;
    return send(peer, wire::whole_frame(wire::FrameKind::welcome, std::as_bytes(std::span(&ends_with_connection, 1))));
}

void RecordingNode::ask_to_begin_again() {
    for (const Peer& peer : peers_)
        if (peer.greeted) send(peer, wire::whole_frame(wire::FrameKind::begin_again, {}));
}

bool RecordingNode::send(const Peer& peer, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::send(peer.fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
}

}  // namespace wall::wallctl
