// SPDX-License-Identifier: MIT
#include "tools/wallagent/doors.h"

#include <cstdio>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "common/log/refusals.h"
#include "common/wire/frame.h"
#include "tools/wallagent/byte_relay.h"

namespace wall::wallagent {
namespace {

constexpr std::size_t kKeyCharacters = 12;  // 72 bits: enough to tell nodes apart

/// FNV-1a, 32 bits, as eight digits.
std::string short_hash(const std::string& text) {
    std::uint32_t hash = 2166136261u;
    for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
    char digits[9];
    std::snprintf(digits, sizeof digits, "%08x", hash);
    return digits;
}

/// Beside the control socket; the same for the same node whenever the agent is started.
std::filesystem::path door_beside(const std::filesystem::path& control, const Door::Node& node) {
    return control.parent_path() / ("agent-" + node.key.text().substr(0, kKeyCharacters) + "-" +
                                    std::to_string(node.address.port) + "-" + short_hash(control.string()) + ".sock");
}

/// Programs report that, and try again.
asio::awaitable<void> say_error(net::Stream& program, const std::string& why) {
    const auto header =
        wire::encode_frame_header({static_cast<std::uint32_t>(why.size()), wire::FrameKind::unreachable});
    std::string bytes(reinterpret_cast<const char*>(header.data()), header.size());
    bytes += why;
    co_await program.write(asio::buffer(bytes));
}

Result<Door::Node> node_of(const std::string& key, const std::string& address) {
    const auto fingerprint = tls::Fingerprint::from_bytes(key);
    if (!fingerprint) return tl::unexpected(fingerprint.error());
    auto to = net::Address::parse(address);
    if (!to) return tl::unexpected(to.error());
    if (to->is_unix()) return fail(address + ": a node of another machine has HOST:PORT");
    return Door::Node{*fingerprint, std::move(*to)};
}

}  // namespace

Door::Door(net::Listener listener, Node node, std::shared_ptr<const tls::TlsContext> own, Places& places)
    : listener_(std::move(listener)), node_(std::move(node)), own_(std::move(own)), places_(places) {}

void Door::open(const asio::any_io_executor& executor) {
    net::keep_accepting(
        executor, listener_, [this, executor](net::StreamSocket socket) { take(executor, std::move(socket)); },
        [this] { return closed_; });
}

void Door::close() {
    closed_ = true;
    listener_.close();
}

void Door::take(const asio::any_io_executor& executor, net::StreamSocket socket) {
    auto place = places_.take();
    if (!place) return log::refused("agent", "this machine", "too many streams at once");
    net::spawn(executor, "stream", serve(net::Stream(std::move(socket)), std::move(place)));
}

asio::awaitable<void> Door::serve(net::Stream program, std::shared_ptr<Places::Place> place) {
    const Node to = node_;  // it may move while we wait for it
    auto node = co_await net::Stream::connect_tls(to.address, *own_, to.key);
    if (closed_) co_return;
    if (!node) {
        log::warn("node_unreachable error={}", log::quoted(node.error().message));
        co_return co_await say_error(program, node.error().message);
    }
    co_await relay_bytes(std::move(program), std::move(*node), std::move(place));
}

Result<std::string> Doors::door_for(const std::string& key, const std::string& address) {
    const auto node = node_of(key, address);
    if (!node) return tl::unexpected(node.error());
    if (const auto found = doors_.find({node->key, node->address.port}); found != doors_.end()) {
        found->second->lead_to(node->address);
        return found->second->address().text();
    }
    const auto opened = open(*node);
    if (!opened) return tl::unexpected(opened.error());
    return (*opened)->address().text();
}

Result<Door*> Doors::open(const Door::Node& node) {
    if (doors_.size() >= kMost) return fail("there are " + std::to_string(kMost) + " doors already");
    const net::Address at{door_beside(control_, node).string(), {}, 0};
    auto listener = net::Listener::open(executor_, at);
    if (!listener) return tl::unexpected(listener.error());
    auto& door = doors_[{node.key, node.address.port}];
    door = std::make_unique<Door>(std::move(*listener), node, own_, places_);
    door->open(executor_);
    log::info("door_open node={} key={} at={}", log::quoted(node.address.text()), log::quoted(node.key.text()),
              log::quoted(at.text()));
    return door.get();
}

void Doors::close() {
    for (const auto& [node, door] : doors_) door->close();
    places_.end_all();
}

}  // namespace wall::wallagent
