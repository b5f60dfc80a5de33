// SPDX-License-Identifier: MIT
// counting_nodes: the nodes of a wall.toml that draw nothing and count what comes (counting_wall.h). A line for each
// frame, process and node goes to a file; what was asked of nodes is said in the end.
#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <fstream>
#include <iostream>
#include <map>

#include "bench/simulate/counting_wall.h"
#include "common/config/load_config.h"
#include "common/net/sockets.h"
#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/gl.h"
#include "tileserver/io/caps_message.h"

namespace {

using namespace wall;

struct Options {
    std::string config, listen, trace, backend = "egl";
};

/// Of the driver that real nodes of this machine would have.
Result<proto::GlCaps> caps_of(const std::string& backend_name) {
    auto backend = tileserver::open_backend({backend_name});
    if (!backend) return tl::unexpected(backend.error());
    if (auto current = (*backend)->make_current(); !current) return tl::unexpected(current.error());
    tileserver::Gl gl;
    gl.load([&](const char* function) { return (*backend)->get_proc_address(function); });
    proto::GlCaps caps;
    tileserver::fill_caps(tileserver::query_caps(gl), caps);
    return caps;
}

Result<void> run(const Options& options) {
    const auto wall = config::load_config(options.config);
    if (!wall) return tl::unexpected(wall.error());
    auto caps = caps_of(options.backend);
    if (!caps) return tl::unexpected(caps.error());
    const auto listen = Address::parse(options.listen);
    if (!listen) return tl::unexpected(listen.error());
    std::ofstream trace(options.trace);
    if (!trace) return fail(options.trace + ": cannot be written");
    trace << "session\trank\tnode\tsurface\tframe\tlink\tplain\tcommands\tblocks\tvertices\tin_pieces\n";
    std::map<std::string, std::uint64_t> questions;
    const auto note = [&](const simulate::FrameTraffic& now) {
        trace << now.session.value << '\t' << now.rank << '\t' << now.node.value << '\t' << now.surface.value << '\t'
              << now.frame << '\t' << now.link_bytes << '\t' << now.traffic.plain_bytes << '\t' << now.traffic.commands
              << '\t' << now.traffic.blocks << '\t' << now.traffic.vertices << '\t' << now.traffic.in_pieces << '\n';
    };
    std::vector<std::string> names;
    for (const auto& node : wall->nodes) names.push_back(node.name);
    boost::asio::io_context io(1);
    std::string failure;
    const auto failed = [&](const std::string& why) {
        if (failure.empty()) failure = why;
        io.stop();
    };
    auto nodes = simulate::CountingWall::open(
        io.get_executor(), wall->control_listen.front(), *listen, std::move(names), std::move(*caps),
        {.frame = note, .question = [&](const std::string& command) { ++questions[command]; }, .failed = failed});
    if (!nodes) return tl::unexpected(nodes.error());
    boost::asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&](const boost::system::error_code& error, int) {
        if (!error) (*nodes)->stop(), io.stop();
    });
    (*nodes)->start();
    io.run();
    for (const auto& [command, times] : questions) std::cout << command << ' ' << times << '\n';
    if (!failure.empty()) return fail(failure);
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"The nodes of a wall, which draw nothing and count what programs send them."};
    Options options;
    app.add_option("--config", options.config, "the wall's description")->required();
    app.add_option("--listen", options.listen, "where programs come, unix:PATH")->required();
    app.add_option("--trace", options.trace, "the file for counts: a line a frame, process and node")->required();
    app.add_option("--backend", options.backend, "whose limits they name: egl or osmesa")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    net::use_all_descriptors();
    const auto done = run(options);
    if (done) return 0;
    std::cerr << "counting_nodes: " << done.error().message << '\n';
    return 1;
}
