// SPDX-License-Identifier: MIT
// wallagent, for machines where people start programs while the wall is on other ones: join, listen, run until a
// signal.
#include <signal.h>
#include <systemd/sd-daemon.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <filesystem>
#include <iostream>

#include "common/daemon/keep_running.h"
#include "common/join/join.h"
#include "common/log/log.h"
#include "common/net/as_tuple.h"
#include "common/net/sockets.h"
#include "common/tls/identity.h"
#include "tools/wallagent/agent.h"

namespace {

using namespace wall;
using namespace wall::wallagent;

constexpr std::chrono::seconds kStopLimit{1};  // what has not ended by itself then is dropped
constexpr int kExitUsage = 2;

struct Options {
    std::string state = "/var/lib/wallgl/agent", listen = net::kDefaultWalld, join;
};

/// What this process is to be.
struct Role {
    net::Address listen;
    join::Membership joined;
    std::shared_ptr<const tls::TlsContext> own;
};

/// Programs are told paths beside this one, and have other working directories.
Result<net::Address> socket_of(const std::string& text) {
    auto address = net::Address::parse(text);
    if (!address) return tl::unexpected(address.error());
    if (!address->is_unix()) return fail("--listen: expected unix:PATH, got '" + text + "'");
    address->path = std::filesystem::absolute(address->path).lexically_normal().string();
    return std::move(*address);
}

Result<std::shared_ptr<const tls::TlsContext>> key_in(const std::string& folder) {
    const auto own = tls::Identity::load_or_make(join::key_file(folder));
    if (!own) return tl::unexpected(own.error());
    auto context = tls::TlsContext::make(*own);
    if (!context) return tl::unexpected(context.error());
    return std::make_shared<const tls::TlsContext>(std::move(*context));
}

Result<void> join_wall(const Options& options) {
    const auto line = tls::JoinLine::parse(options.join);
    if (!line) return tl::unexpected(line.error());
    const auto joined = join::join(*line, join::MachineKind::client, options.state);
    if (!joined) return tl::unexpected(joined.error());
    log::info("joined name={} walld={}", log::quoted(joined->name), log::quoted(joined->walld.text()));
    return {};
}

Result<Role> role_of(const Options& options) {
    auto listen = socket_of(options.listen);
    if (!listen) return tl::unexpected(listen.error());
    if (!options.join.empty())
        if (auto joined = join_wall(options); !joined) return tl::unexpected(joined.error());
    auto joined = join::Membership::load(options.state);
    if (!joined) return tl::unexpected(joined.error());
    if (joined->kind != join::MachineKind::client)
        return fail(options.state + ": this machine has joined as a node, not as a client host");
    auto own = key_in(options.state);
    if (!own) return tl::unexpected(own.error());
    return Role{std::move(*listen), std::move(*joined), std::move(*own)};
}

/// systemd hears that the thread is alive as often as it wants to.
asio::awaitable<void> feed_watchdog(asio::steady_timer& timer, const bool& stopping) {
    std::uint64_t limit = 0;  // microseconds
    const bool wanted = sd_watchdog_enabled(0, &limit) > 0;
    while (!stopping) {
        if (wanted) sd_notify(0, "WATCHDOG=1");
        timer.expires_after(wanted ? std::chrono::microseconds(limit / 2) : std::chrono::hours(1));
        co_await timer.async_wait(net::kTuple);
    }
}

Result<void> run(const Role& role) {
    asio::io_context io(1);
    auto agent = Result<std::unique_ptr<Agent>>(nullptr);
    const auto open = [&]() -> Result<void> {
        agent = Agent::open(io.get_executor(), role.listen, role.joined, role.own);
        return agent ? Result<void>() : tl::unexpected(agent.error());
    };
    if (auto opened = net::listen_patiently(open); !opened) return opened;
    asio::steady_timer watchdog(io);
    asio::signal_set signals(io, SIGINT, SIGTERM);
    bool stopping = false;
    net::keep_running(io.get_executor(),
                      {"watchdog", [&] { return feed_watchdog(watchdog, stopping); }, [&] { return stopping; }});
    signals.async_wait([&](const boost::system::error_code& error, int signal) {
        if (error) return;
        log::info("stopping signal={}", signal);
        sd_notify(0, "STOPPING=1");
        stopping = true;
        (*agent)->stop();
        watchdog.cancel();
        io.stop();
    });
    (*agent)->start();
    sd_notify(0, ("READY=1\nSTATUS=" + role.joined.name + " of the wall at " + role.joined.walld.text()).c_str());
    log::info("ready name={} walld={} listen={}", log::quoted(role.joined.name), log::quoted(role.joined.walld.text()),
              log::quoted(role.listen.text()));
    io.run();
    io.restart();
    io.run_for(kStopLimit);  // connections see that they are closed
    log::info("stopped");
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "wallagent: lets programs of this machine draw on a wall of other machines. Programs, wallrun and wallctl "
        "find\n"
        "it where walld would be. The first time with the line that `wallctl join-token client` prints: --join LINE.");
    Options options;
    app.add_option("--state", options.state, "where this machine keeps its key and what it knows of the wall")
        ->type_name("FOLDER")
        ->capture_default_str();
    app.add_option("--listen", options.listen, "where programs find it")->type_name("unix:PATH")->capture_default_str();
    app.add_option("--join", options.join, "joins a wall first, with a line of `wallctl join-token`")
        ->type_name("LINE");
    app.set_version_flag("--version", WALLGL_VERSION);
    CLI11_PARSE(app, argc, argv);

    ::signal(SIGPIPE, SIG_IGN);
    net::use_all_descriptors();
    log::begin("wallagent");
    try {
        const auto role = role_of(options);
        if (!role) {
            std::cerr << "wallagent: " << role.error().message << '\n';
            return kExitUsage;
        }
        if (auto done = run(*role); !done) {
            std::cerr << "wallagent: " << done.error().message << '\n';
            return 1;
        }
    } catch (const std::exception& error) {
        std::cerr << "wallagent: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
