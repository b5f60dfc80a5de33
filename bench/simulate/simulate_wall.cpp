// SPDX-License-Identifier: MIT
// simulate_wall: a scene (scene_file.h) through the model (model.h). JSON on standard output.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/simulate/scene_file.h"

namespace {

using namespace wall;

nlohmann::json json_of(const simulate::Figures& figures, double computing) {
    nlohmann::json out{{"time", figures.time}, {"events", figures.events}, {"computing", computing}};
    for (const auto& program : figures.programs)
        out["programs"].push_back({{"frames_per_second", program.frames_per_second},
                                   {"longest", program.longest},
                                   {"delay", program.delay},
                                   {"bytes_per_frame", program.bytes_per_frame}});
    simulate::HostFigures busiest;
    for (const auto& host : figures.hosts) {
        out["hosts"].push_back({{"processors", host.processors}, {"up", host.up}, {"down", host.down}});
        busiest.processors = std::max(busiest.processors, host.processors);
        busiest.up = std::max(busiest.up, host.up);
        busiest.down = std::max(busiest.down, host.down);
    }
    out["busiest"] = {{"processors", busiest.processors}, {"up", busiest.up}, {"down", busiest.down}};
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"How fast a wall would be: a scene of machines, links, nodes and programs, as JSON."};
    std::string file;
    app.add_option("SCENE", file, "the scene's file (bench/simulate/scene_file.h says what is in it)")->required();
    CLI11_PARSE(app, argc, argv);
    const auto begin = std::chrono::steady_clock::now();
    const auto figures = simulate::read_scene(file).and_then(simulate::simulate);
    if (!figures) {
        std::cerr << "simulate_wall: " << figures.error().message << '\n';
        return 1;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::cout << json_of(*figures, took.count()).dump(1) << '\n';
    return 0;
}
