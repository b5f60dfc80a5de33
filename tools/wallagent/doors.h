// SPDX-License-Identifier: MIT
// Unix sockets that stand for the nodes of other machines: who connects to one gets a TLS connection to its node. The
// node decides by the ticket whom it takes, so a door asks nobody anything. One executor, one thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "common/net/control_connection.h"
#include "common/tls/tls_context.h"
#include "tools/wallagent/places.h"

namespace wall::wallagent {

namespace asio = boost::asio;

/// Of one node. It must outlive its executor's handlers.
class Door {
public:
    struct Node {
        tls::Fingerprint key;
        net::Address address;
    };
    /// `own` is what this machine proves; connections take one of `places`, which outlives the door.
    Door(net::Listener listener, Node node, std::shared_ptr<const tls::TlsContext> own, Places& places);

    void open(const asio::any_io_executor& executor);
    void close();
    /// The node's machine has another address now.
    void lead_to(const net::Address& address) { node_.address = address; }
    const net::Address& address() const { return listener_.address(); }

private:
    void take(const asio::any_io_executor& executor, net::StreamSocket socket);
    asio::awaitable<void> serve(net::Stream program, std::shared_ptr<Places::Place> place);

    net::Listener listener_;
    Node node_;
    std::shared_ptr<const tls::TlsContext> own_;
    Places& places_;
    bool closed_ = false;
};

/// One for each node's key and port: a machine has a node for each of its GPUs. They stay as long as the agent runs: a
/// program may come back to its node at any time.
class Doors {
public:
    static constexpr std::size_t kMost = 1024, kMostStreams = 4096;

    /// The doors are beside the socket `control`, and named after it: several agents may share a folder.
    Doors(asio::any_io_executor executor, std::shared_ptr<const tls::TlsContext> own, std::filesystem::path control)
        : executor_(std::move(executor)), own_(std::move(own)), control_(std::move(control)) {}

    /// The address of the door to the node that has `key` (32 bytes) and is at `address`; a new one opens if need be.
    Result<std::string> door_for(const std::string& key, const std::string& address);
    /// Nobody gets in any more, and who is in is cut off.
    void close();

private:
    Result<Door*> open(const Door::Node& node);

    asio::any_io_executor executor_;
    std::shared_ptr<const tls::TlsContext> own_;
    std::filesystem::path control_;
    Places places_{kMostStreams};
    std::map<std::pair<tls::Fingerprint, std::uint16_t>, std::unique_ptr<Door>> doors_;
};

}  // namespace wall::wallagent
