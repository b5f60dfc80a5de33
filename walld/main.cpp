// SPDX-License-Identifier: MIT
// walld, the wall's control daemon: read wall.toml, listen, run until a signal.
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/config/load_config.h"
#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "common/net/as_tuple.h"
#include "common/net/sockets.h"
#include "common/tls/identity.h"
#include "walld/control/control_server.h"
#include "walld/control/random_bytes.h"
#include "walld/control/service_manager.h"
#include "walld/http/http_server.h"
#include "walld/mpcdi/load_mpcdi.h"

namespace {

using namespace wall;
using namespace wall::walld;

constexpr std::chrono::seconds kStopLimit{1};  // what has not ended by itself then is dropped
constexpr int kExitUsage = 2;

struct Options {
    std::string config;
    std::string ready_file;
    bool check = false;
};

/// For whoever starts a wall with port 0: written whole, then given its name.
void write_ready_file(const std::string& path, const ControlServer& control, const HttpServer& http) {
    nlohmann::json ready{{"pid", ::getpid()}, {"control", nlohmann::json::array()}};
    for (const auto& address : control.addresses()) ready["control"].push_back(address.text());
    for (const auto& url : http.urls())
        ready.emplace(url.starts_with("https") ? "https" : "http", url);  // the first of each
    std::ofstream(path + ".new") << ready.dump() << '\n';
    if (std::rename((path + ".new").c_str(), path.c_str()) != 0)
        log::error("ready_file_failed path={}", log::quoted(path));
}

/// systemd hears that the thread is alive as often as it wants to.
asio::awaitable<void> feed_watchdog(asio::steady_timer& timer, const bool& stopping) {
    const auto interval = watchdog_interval();
    while (!stopping) {
        if (interval) notify_alive();
        timer.expires_after(interval.value_or(std::chrono::hours(1)));
        co_await timer.async_wait(net::kTuple);
    }
}

/// What the description says, else what systemd made for us.
std::string state_directory(const config::WallConfig& config) {
    const char* given = std::getenv("STATE_DIRECTORY");
    return !config.state_directory.empty() ? config.state_directory : given ? given : "";
}

/// A key for links with other machines, if walld shall have any.
Result<WalldKeys> open_keys(const config::WallConfig& config, const std::string& state) {
    auto machines = Machines::open(state);
    if (!machines) return tl::unexpected(machines.error());
    WalldKeys out{nullptr, std::move(*machines)};
    const bool alone = std::ranges::all_of(config.control_listen, &net::Address::local) &&
                       std::ranges::all_of(config.http_listen, &net::Address::local);
    if (state.empty() || alone) return out;  // without a place for its key walld listens nowhere else, and says so
    const auto own = tls::Identity::load_or_make(std::filesystem::path(state) / "key.pem");
    if (!own) return tl::unexpected(own.error());
    auto context = tls::TlsContext::make(*own);
    if (!context) return tl::unexpected(context.error());
    out.tls = std::make_shared<const tls::TlsContext>(std::move(*context));
    log::info("own_key fingerprint={}", log::quoted(out.tls->fingerprint().text()));
    return out;
}

std::string status_of(const ControlServer& control) { return "wall " + control.wall().config().name; }

/// SIGHUP does what `wallctl reload` does.
asio::awaitable<void> reload_on(asio::signal_set& signals, ControlServer& control, const bool& stopping) {
    while (!stopping) {
        const auto [error, signal] = co_await signals.async_wait(net::kTuple);
        if (error) continue;
        notify_reloading();
        if (const auto done = control.description().reload(); done)
            log::info("reloaded nodes={}", log::quoted(done->dump()));
        else log::error("reload_refused reason={}", log::quoted(done.error().message));
        notify_ready(status_of(control));
    }
}

/// `config`: of wall.toml alone.
Result<void> run(const config::WallConfig& config, const Options& options) {
    asio::io_context io(1);
    const auto state = state_directory(config);
    WallFile file(options.config, state);
    auto description = file.read();
    if (!description) return fail(description.error().message);
    const auto http_listen = description->config.http_listen;  // which stays as long as this process
    auto identities = Identities::open(description->config.people, state);
    if (!identities) return tl::unexpected(identities.error());
    auto keys = open_keys(description->config, state);
    if (!keys) return tl::unexpected(keys.error());
    const auto own = keys->tls;
    ControlServer control(io.get_executor(), std::move(*description), std::move(file), std::move(*identities),
                          std::move(*keys), state);
    const WallMetrics metrics(control.wall(), control.streams(), WALLGL_VERSION);
    HttpServer http(io.get_executor(), control.wall(), control.identities(), control.who_is_there(),
                    control.operators(), control.streams(), metrics, random_bytes, own);
    const auto listen_http = [&] { return http.listen(http_listen); };
    if (auto listening = net::listen_patiently([&] { return control.listen(); }); !listening) return listening;
    if (auto listening = net::listen_patiently(listen_http); !listening) return listening;
    control.operators().tell_page(http.urls(), own ? own->certificate_digest() : "");
    if (!options.ready_file.empty()) write_ready_file(options.ready_file, control, http);

    asio::steady_timer watchdog(io);
    asio::signal_set signals(io, SIGINT, SIGTERM), hangups(io, SIGHUP);
    bool stopping = false;
    net::keep_running(io.get_executor(),
                      {"watchdog", [&] { return feed_watchdog(watchdog, stopping); }, [&] { return stopping; }});
    net::keep_running(io.get_executor(),
                      {"reload", [&] { return reload_on(hangups, control, stopping); }, [&] { return stopping; }});
    signals.async_wait([&](const boost::system::error_code& error, int signal) {
        if (error) return;
        log::info("stopping signal={}", signal);
        notify_stopping();
        stopping = true;
        http.stop();
        control.stop();
        watchdog.cancel();
        hangups.cancel();
        io.stop();
    });
    notify_ready(status_of(control));
    log::info("ready wall={} nodes={}", log::quoted(control.wall().config().name), control.wall().nodes().size());
    io.run();
    io.restart();
    io.run_for(kStopLimit);  // connections see that they are closed
    log::info("stopped");
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "walld: the control daemon of a WallGL wall. It knows the nodes, the programs and their windows, and says "
        "when\n"
        "a frame is shown. Nodes (tileserver) and programs (wallrun) connect to it; operators use wallctl or the "
        "status page.");
    Options options;
    app.add_option("--config", options.config, "wall.toml, the description of the wall (docs/operation.md)")
        ->required();
    app.add_option("--ready-file", options.ready_file,
                   "write the addresses in use here, as JSON, once everything listens");
    app.add_flag("--check", options.check, "only check the description");
    app.set_version_flag("--version", WALLGL_VERSION);
    CLI11_PARSE(app, argc, argv);

    ::signal(SIGPIPE, SIG_IGN);
    net::use_all_descriptors();
    log::begin("walld");
    try {
        auto config = config::load_config(options.config);
        const auto warps =
            config ? mpcdi::DescribedFiles().load(*config, std::filesystem::path(options.config).parent_path())
                   : tl::unexpected(config.error());
        if (!warps) {
            std::cerr << "walld: " << warps.error().message << '\n';
            return kExitUsage;
        }
        if (options.check) return 0;
        if (auto done = run(*config, options); !done) {
            std::cerr << "walld: " << done.error().message << '\n';
            return 1;
        }
    } catch (const std::exception& error) {
        std::cerr << "walld: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
