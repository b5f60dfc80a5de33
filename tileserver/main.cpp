// SPDX-License-Identifier: MIT
// tileserver, one node of a wall: read wall.toml, open the driver, serve clients until a signal.
#include <signal.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string_view>
#include <system_error>
#include <vector>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "common/net/as_tuple.h"
#include "common/net/sockets.h"
#include "tileserver/gpu/gpu_devices.h"
#include "tileserver/gpu/memory.h"
#include "tileserver/gpu_processes.h"
#include "tileserver/io/node_server.h"
#include "tileserver/kms/cards.h"
#include "tileserver/node_role.h"
#include "tileserver/render/continued.h"

namespace {

using namespace wall;
using namespace wall::tileserver;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kStopLimit{2};     // what has not ended by itself then is dropped
constexpr std::chrono::seconds kRenderStall{30};  // a render thread that says nothing for so long hangs

/// Tells systemd that both threads are alive, as often as it wants to hear it.
asio::awaitable<void> feed_watchdog(asio::steady_timer& timer, const NodeServer& server, const bool& stopping) {
    std::uint64_t limit = 0;  // microseconds
    const bool wanted = sd_watchdog_enabled(0, &limit) > 0;
    while (!stopping) {
        if (wanted && Clock::now() - server.last_sign_of_life() < kRenderStall) sd_notify(0, "WATCHDOG=1");
        timer.expires_after(wanted ? std::chrono::microseconds(limit / 2) : std::chrono::hours(1));
        co_await timer.async_wait(net::kTuple);
    }
}

enum class Ended { stopped, starts_anew };

Result<Ended> run(const NodeRole& role) {
    const auto& node = *role.node();
    const auto described = [&role](const std::string& wall_toml) { return role.described(wall_toml); };
    const auto compilers =
        CompilerHost::start({config::name_of(node.backend), node.gpu()});  // forks: before there are threads
    if (!compilers) return tl::unexpected(compilers.error());
    asio::io_context io(1);
    auto server = Result<std::unique_ptr<NodeServer>>(nullptr);
    const auto open = [&]() -> Result<void> {
        server = NodeServer::open(io.get_executor(), role.wall(), node, compilers->get(), role.keys(), described);
        return server ? Result<void>() : tl::unexpected(server.error());
    };
    if (auto opened = net::listen_patiently(open); !opened) return tl::unexpected(opened.error());
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
    while (!stopping && !(*server)->failure() && !(*server)->starts_anew()) io.run_one();
    const auto failure = (*server)->failure();
    const auto ended = stopping ? Ended::stopped : Ended::starts_anew;
    stopping = true;
    (*server)->stop();
    signals.cancel();
    watchdog.cancel();
    io.run_for(kStopLimit);
    server->reset();
    if (failure) return fail(*failure);
    if (ended == Ended::stopped) log::info("stopped");
    else log::info("starting_anew reason=\"described otherwise\"");
    return ended;
}

/// This program, as it was started; or what an upgrade has put in its place.
std::vector<std::string> command_of(const RoleSource& source) {
    constexpr std::string_view kReplaced = " (deleted)";  // as the kernel says it
    std::error_code error;
    std::vector<std::string> out{std::filesystem::read_symlink("/proc/self/exe", error).string()};
    if (out[0].ends_with(kReplaced)) out[0].resize(out[0].size() - kReplaced.size());
    const auto add = [&](const char* option, const std::string& value) {
        if (!value.empty()) out.insert(out.end(), {option, value});
    };
    add("--config", source.config);
    add("--node", source.node);
    add("--state", source.state);
    add("--gpu", source.gpu);
    return out;
}

/// The same process from its beginning: it reads again what it is.
[[noreturn]] void start_anew(const RoleSource& source) {
    const auto command = command_of(source);
    std::vector<char*> arguments;
    for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    ::execv(arguments.front(), arguments.data());
    // Whoever started us starts the program that was put in our place.
    throw std::system_error(errno, std::generic_category(), command.front());
}

/// A node of several GPUs.
Result<GpuProcesses::Ended> run_all(const NodeRole& role, const RoleSource& source) {
    std::vector<std::string> gpus;
    for (const auto& node : role.nodes()) gpus.push_back(node.name);
    const auto command = [&source](const std::string& gpu) {
        auto of_gpu = source;
        of_gpu.gpu = gpu;
        return command_of(of_gpu);
    };
    const std::string name = role.nodes().front().process;
    const auto ready = [&] {
        sd_notify(0, ("READY=1\nSTATUS=node " + name).c_str());
        log::info("ready node={} gpus={}", log::quoted(name), gpus.size());
    };
    return GpuProcesses(gpus, command, ready).run();
}

/// An error of whoever starts us, in one sentence.
int refuse_start(const std::string& why) {
    std::cerr << "tileserver: " << why << '\n';
    return kExitMistake;
}

int fail_with(const std::string& why) {
    std::cerr << "tileserver: " << why << '\n';
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    wall::tileserver::keep_freed_memory();
    wall::tileserver::continued::expect();
    CLI::App app(
        "tileserver: one node of a WallGL wall. It draws what programs send it for its tiles. It connects to walld by "
        "itself,\n"
        "whenever that is there. On walld's machine: --config and --node. On another one, first with the line that\n"
        "`wallctl join-token node NAME` prints: --state FOLDER --join LINE; later --state FOLDER.");
    RoleSource source;
    std::string line;
    auto* config =
        app.add_option("--config", source.config, "wall.toml, the description of the wall (docs/operation.md)");
    app.add_option("--node", source.node, "which of its [[node]]s this one is")->needs(config);
    app.add_option(
        "--gpu", source.gpu,
        "draws with this one of its GPUs only, such as NAME/gpu1 (docs/gpus.md); without it, a process for each "
        "is started");
    auto* state = app.add_option("--state", source.state,
                                 "where this machine keeps its key, and what it knows of the wall that it has joined");
    bool list_gpus = false, list_monitors = false;
    app.add_flag("--gpus", list_gpus, "only lists this machine's GPUs, for `gpu` in wall.toml")->excludes(config);
    app.add_flag("--monitors", list_monitors,
                 "only lists this machine's monitors as the kernel knows them, for `output` and `mode` in wall.toml")
        ->excludes(config);
    app.add_option("--join", line, "joins a wall of another machine, with a line of `wallctl join-token`")
        ->needs(state)
        ->excludes(config);
    app.set_version_flag("--version", WALLGL_VERSION);
    CLI11_PARSE(app, argc, argv);
    if (list_gpus) {
        std::cout << gpu_table();
        return 0;
    }
    if (list_monitors) {
        std::cout << monitor_table();
        return 0;
    }
    const bool of_file = !source.config.empty() && !source.node.empty();
    const bool of_state = source.config.empty() && source.node.empty() && !source.state.empty();
    if (!of_file && !of_state)
        return refuse_start("expected --config FILE --node NAME, or --state FOLDER (--help tells more)");

    ::signal(SIGPIPE, SIG_IGN);
    net::use_all_descriptors();
    log::begin("tileserver " + (source.gpu.empty() ? source.node : source.gpu));
    try {
        if (!line.empty())
            if (auto joined = NodeRole::join(line, source.state); !joined) return refuse_start(joined.error().message);
        const auto role = NodeRole::find(source);
        if (!role) return refuse_start(role.error().message);
        if (role->node() == nullptr) {
            const auto ended = run_all(*role, source);
            if (ended && *ended == GpuProcesses::Ended::starts_anew) start_anew(source);
            if (!ended) return fail_with(ended.error().message);
            return *ended == GpuProcesses::Ended::mistaken ? kExitMistake : 0;
        }
        const auto ended = run(*role);
        if (!ended) return fail_with(ended.error().message);
        if (*ended == Ended::starts_anew && !source.gpu.empty()) return kExitDescribed;  // its parent does
        if (*ended == Ended::starts_anew) start_anew(source);
    } catch (const std::exception& error) {
        return fail_with(error.what());
    }
    return 0;
}
