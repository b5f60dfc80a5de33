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
#include "common/log/log.h"
#include "common/net/sockets.h"
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

Result<void> run(const config::WallConfig& wall, const config::NodeConfig& node) {
    const auto compilers = CompilerHost::start(config::name_of(node.backend));  // forks: before there are threads
    if (!compilers) return tl::unexpected(compilers.error());
    asio::io_context io(1);
    auto server = Result<std::unique_ptr<NodeServer>>(nullptr);
    const auto open = [&]() -> Result<void> {
        server = NodeServer::open(io.get_executor(), wall, node, compilers->get());
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

}  // namespace

int main(int argc, char** argv) {
    wall::tileserver::keep_freed_memory();
    CLI::App app(
        "tileserver: one node of a WallGL wall. It draws what programs send it for its tiles. It connects to walld by "
        "itself,\n"
        "whenever that is there.");
    std::string config_path, node_name;
    app.add_option("--config", config_path, "wall.toml, the description of the wall (docs/operation.md)")->required();
    app.add_option("--node", node_name, "which of its [[node]]s this one is")->required();
    app.set_version_flag("--version", WALLGL_VERSION);
    CLI11_PARSE(app, argc, argv);

    ::signal(SIGPIPE, SIG_IGN);
    net::use_all_descriptors();
    log::begin("tileserver " + node_name);
    try {
        const auto wall = config::load_config(config_path);
        if (!wall) {
            std::cerr << "tileserver: " << wall.error().message << '\n';
            return kExitUsage;
        }
        const auto* node = wall->find_node(node_name);
        if (node == nullptr) {
            std::cerr << "tileserver: " << config_path << ": no [[node]] has the name \"" << node_name << "\"\n";
            return kExitUsage;
        }
        if (auto done = run(*wall, *node); !done) {
            std::cerr << "tileserver: " << done.error().message << '\n';
            return 1;
        }
    } catch (const std::exception& error) {
        std::cerr << "tileserver: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
