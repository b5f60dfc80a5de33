// SPDX-License-Identifier: MIT
// The real walld in a folder of its own, and peers that speak the control protocol to it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>

#include "common/base/ids.h"
#include "common/net/control_client.h"
#include "tests/support/temporary_folder.h"

namespace wall::test {

inline constexpr std::chrono::seconds kSoon{10};  ///< an answer that is not there by then will not come

struct Ended {
    int exit_code = -1;  ///< -1: not by itself
    std::string said;    ///< on stderr
};

class Walld {
public:
    /// `more` goes into wall.toml. Two nodes, `left` and `right`, with a tile of 64x48 pixels each.
    explicit Walld(const std::string& more = "");
    ~Walld();

    /// Waits until it listens; throws if it does not.
    net::ControlClient connect();
    net::Address address() const { return *net::Address::parse("unix:" + folder_.file("walld.sock")); }
    /// The body of an HTTP answer; "" unless it is 200.
    std::string http_get(const std::string& path) const;
    /// Where it serves HTTP; it must be ready.
    net::Address http() const { return *net::Address::parse(http_); }
    void signal(int number) const;
    /// Waits for its end.
    Ended wait(std::chrono::milliseconds limit = kSoon);

private:
    TemporaryFolder folder_;
    bool ready();
    std::string http_;
    pid_t process_ = -1;
};

/// A node or a program, as far as walld can tell.
class Peer {
public:
    explicit Peer(net::ControlClient client) : client_(std::move(client)) {}

    void say(const proto::Envelope& message);
    /// The next message of this kind; earlier ones are skipped. Nothing if the connection ends first or it takes too
    /// long.
    std::optional<proto::Envelope> hear(proto::Envelope::MessageCase kind, std::chrono::milliseconds limit = kSoon);
    bool closed(std::chrono::milliseconds limit = kSoon);

    proto::NodeWelcome join(const std::string& node, std::uint32_t pid = 1, std::uint64_t started_us = 0);
    proto::ClientWelcome open(const proto::ClientHello& hello = {});
    proto::Placement open_surface(SurfaceId surface, std::uint32_t width, std::uint32_t height);
    void rendered(SessionId session, SurfaceId surface, std::uint32_t frame);

private:
    net::ControlClient client_;
};

/// Runs a program to its end; gives its output and exit code.
struct Output {
    int exit_code = -1;
    std::string text;
};
Output run(const std::string& command);

}  // namespace wall::test
