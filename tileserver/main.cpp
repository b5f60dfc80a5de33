// SPDX-License-Identifier: MIT
// tileserver, one node of a wall: read wall.toml, open the driver, serve clients until a signal.
#include <signal.h>
#include <systemd/sd-daemon.h>

#include <CLI/CLI.hpp>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstdlib>
#include <iostream>

#include "common/config/load_config.h"
#include "common/daemon/keep_running.h"
#include "common/join/join.h"
#include "common/log/log.h"
#include "common/net/sockets.h"
#include "common/tls/identity.h"
#include "tileserver/gpu/memory.h"
#include "tileserver/io/node_server.h"

namespace {

using namespace wall;
using namespace wall::tileserver;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kStopLimit{2};     // what has not ended by itself then is dropped
constexpr std::chrono::seconds kRenderStall{30};  // a render thread that says nothing for so long hangs
constexpr int kExitUsage = 2;

/// Tells systemd that both threads are alive, as often as it wants to hear it.
asio::awaitable<void> feed_watchdog(asio::steady_timer& timer, const NodeServer& server, const bool& stopping) {
    std::uint64_t limit = 0;  // microseconds
    const bool wanted = sd_watchdog_enabled(0, &limit) > 0;
    while (!stopping) {
        if (wanted && Clock::now() - server.last_sign_of_life() < kRenderStall) sd_notify(0, "WATCHDOG=1");
        timer.expires_after(wanted ? std::chrono::microseconds(limit / 2) : std::chrono::hours(1));
        co_await timer.async_wait(asio::as_tuple(asio::use_awaitable));
    }
}

Result<void> run(const config::WallConfig& wall, const config::NodeConfig& node, const NodeKeys& keys) {
    const auto compilers = CompilerHost::start(config::name_of(node.backend));  // forks: before there are threads
    if (!compilers) return tl::unexpected(compilers.error());
    asio::io_context io(1);
    auto server = Result<std::unique_ptr<NodeServer>>(nullptr);
    const auto open = [&]() -> Result<void> {
        server = NodeServer::open(io.get_executor(), wall, node, compilers->get(), keys);
        return server ? Result<void>() : tl::unexpected(server.error());
    };
    if (auto opened = net::listen_patiently(open); !opened) return opened;
    asio::steady_timer watchdog(io);
    bool stopping = false;
    asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&](const boost::system::error_code& error, int signal) {
        if (error) return;
        log::info("stopping signal={}", signal);
        sd_notify(0, "STOPPING=1");
        stopping = true;
    });
    net::keep_running(io.get_executor(), {"watchdog", [&] { return feed_watchdog(watchdog, **server, stopping); },
                                          [&] { return stopping; }});
    (*server)->start();
    sd_notify(0, ("READY=1\nSTATUS=node " + node.name).c_str());
    log::info("ready node={} backend={} listen={}", log::quoted(node.name), log::plain(config::name_of(node.backend)),
              log::quoted((*server)->address().text()));
    while (!stopping && !(*server)->failure()) io.run_one();
    const auto failure = (*server)->failure();
    stopping = true;
    (*server)->stop();
    signals.cancel();
    watchdog.cancel();
    io.run_for(kStopLimit);
    server->reset();
    if (failure) return fail(*failure);
    log::info("stopped");
    return {};
}

struct Options {
    std::string config, node, state, join;
};

/// The node that this process is to be.
struct Role {
    config::WallConfig wall;
    std::string node;
    NodeKeys keys;
};

Result<NodeKeys> keys_in(const std::string& folder) {
    const auto own = tls::Identity::load_or_make(join::key_file(folder));
    if (!own) return tl::unexpected(own.error());
    auto context = tls::TlsContext::make(*own);
    if (!context) return tl::unexpected(context.error());
    return NodeKeys{std::make_shared<const tls::TlsContext>(std::move(*context)), std::nullopt};
}

Result<void> join_wall(const Options& options) {
    const auto line = tls::JoinLine::parse(options.join);
    if (!line) return tl::unexpected(line.error());
    const auto joined = join::join(*line, join::MachineKind::node, options.state);
    if (!joined) return tl::unexpected(joined.error());
    log::info("joined name={} walld={}", log::quoted(joined->name), log::quoted(joined->walld.text()));
    return {};
}

/// Of another machine's wall: by what was kept when it joined.
Result<Role> joined_role(const std::string& folder) {
    const auto joined = join::Membership::load(folder);
    if (!joined) return tl::unexpected(joined.error());
    if (joined->kind != join::MachineKind::node) return fail(folder + ": this machine has joined as a client host");
    auto wall = config::load_config(join::wall_file(folder));
    if (!wall) return tl::unexpected(wall.error());
    auto keys = keys_in(folder);
    if (!keys) return tl::unexpected(keys.error());
    keys->joined = JoinedWall{joined->walld, joined->walld_key};
    return Role{std::move(*wall), joined->name, std::move(*keys)};
}

Result<Role> role_of(const Options& options) {
    if (options.config.empty()) return joined_role(options.state);
    auto wall = config::load_config(options.config);
    if (!wall) return tl::unexpected(wall.error());
    auto keys = options.state.empty() ? Result<NodeKeys>(NodeKeys{}) : keys_in(options.state);
    if (!keys) return tl::unexpected(keys.error());
    return Role{std::move(*wall), options.node, std::move(*keys)};
}

/// An error of whoever starts us, in one sentence.
int refuse_start(const std::string& why) {
    std::cerr << "tileserver: " << why << '\n';
    return kExitUsage;
}

}  // namespace

int main(int argc, char** argv) {
    wall::tileserver::keep_freed_memory();
    CLI::App app(
        "tileserver: one node of a WallGL wall. It draws what programs send it for its tiles. It connects to walld by "
        "itself,\n"
        "whenever that is there. On walld's machine: --config and --node. On another one, first with the line that\n"
        "`wallctl join-token node NAME` prints: --state FOLDER --join LINE; later --state FOLDER.");
    Options options;
    auto* config =
        app.add_option("--config", options.config, "wall.toml, the description of the wall (docs/operation.md)");
    app.add_option("--node", options.node, "which of its [[node]]s this one is")->needs(config);
    auto* state = app.add_option("--state", options.state,
                                 "where this machine keeps its key, and what it knows of the wall that it has joined");
    app.add_option("--join", options.join, "joins a wall of another machine, with a line of `wallctl join-token`")
        ->needs(state)
        ->excludes(config);
    app.set_version_flag("--version", WALLGL_VERSION);
    CLI11_PARSE(app, argc, argv);
    const bool of_file = !options.config.empty() && !options.node.empty();
    const bool of_state = options.config.empty() && options.node.empty() && !options.state.empty();
    if (!of_file && !of_state)
        return refuse_start("expected --config FILE --node NAME, or --state FOLDER (--help tells more)");

    ::signal(SIGPIPE, SIG_IGN);
    net::use_all_descriptors();
    log::begin("tileserver " + options.node);
    try {
        if (!options.join.empty())
            if (auto joined = join_wall(options); !joined) return refuse_start(joined.error().message);
        const auto role = role_of(options);
        if (!role) return refuse_start(role.error().message);
        const auto* node = role->wall.find_node(role->node);
        if (node == nullptr) return refuse_start(options.config + ": no [[node]] has the name \"" + role->node + "\"");
        if (auto done = run(role->wall, *node, role->keys); !done) {
            std::cerr << "tileserver: " << done.error().message << '\n';
            return 1;
        }
    } catch (const std::exception& error) {
        std::cerr << "tileserver: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
