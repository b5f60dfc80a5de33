// SPDX-License-Identifier: MIT
#include "bench/simulate/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

namespace wall::simulate {
namespace {

using nlohmann::json;

/// A line of a trace.
struct Row {
    std::uint32_t rank = 0, node = 0, frame = 0;
    double link = 0, vertices = 0, in_pieces = 0;
};

struct Cost {
    Seconds pack = 0, send_byte = 0, send_message = 0;
    Seconds draw_byte = 0, draw_vertex = 0, draw_frame = 0;
    double piece_share = 1;
    double link_factor = 1, link_message = 0;
};

Result<std::vector<Row>> read_trace(const std::string& file) {
    std::ifstream in(file);
    if (!in) return fail(file + ": cannot be read");
    std::string line;
    std::getline(in, line);
    const std::string head = "session\trank\tnode\tsurface\tframe\tlink\tplain\tcommands\tblocks\tvertices\tin_pieces";
    if (line != head) return fail(file + ":1: expected the columns " + head);
    std::vector<Row> rows;
    for (int number = 2; std::getline(in, line); ++number) {
        std::istringstream words(line);
        Row row;
        std::uint64_t session = 0, surface = 0, plain = 0, commands = 0, blocks = 0;
        words >> session >> row.rank >> row.node >> surface >> row.frame >> row.link >> plain >> commands >> blocks >>
            row.vertices >> row.in_pieces;
        if (!words) return fail(file + ":" + std::to_string(number) + ": expected eleven numbers");
        rows.push_back(row);
    }
    return rows;
}

Cost read_cost(const json& program) {
    Cost cost;
    cost.pack = program.value("pack", 0.0);
    const json send = program.value("send", json::object()), draw = program.value("draw", json::object()),
               link = program.value("link", json::object());
    cost.send_byte = send.value("byte", 0.0);
    cost.send_message = send.value("message", 0.0);
    cost.draw_byte = draw.value("byte", 0.0);
    cost.draw_vertex = draw.value("vertex", 0.0);
    cost.piece_share = draw.value("piece_share", 1.0);
    cost.draw_frame = draw.value("frame", 0.0);
    cost.link_factor = link.value("byte", 1.0);
    cost.link_message = link.value("message", 0.0);
    return cost;
}

Message message_of(const Row& row, NodeIndex node, const Cost& cost) {
    const double vertices = row.vertices - row.in_pieces * (1 - cost.piece_share);
    return {.node = node,
            .bytes = row.link * cost.link_factor + cost.link_message,
            .draw = row.link * cost.draw_byte + vertices * cost.draw_vertex,
            .finish = cost.draw_frame};
}

/// What the trace says of each rank, frame by frame.
Result<std::vector<Member>> members_of(const json& program, const std::vector<Row>& rows) {
    const auto hosts = program.at("hosts").get<std::vector<std::uint32_t>>();
    const auto nodes = program.at("nodes").get<std::vector<std::uint32_t>>();
    const auto skip = program.value("skip", 1u), last = program.value("last", ~0u);
    const Cost cost = read_cost(program);
    std::vector<std::map<std::uint32_t, Frame>> frames(hosts.size());
    for (const Row& row : rows) {
        if (row.rank >= hosts.size())
            return fail("its trace has rank " + std::to_string(row.rank) + ", and it has " +
                        std::to_string(hosts.size()) + " hosts");
        if (row.node >= nodes.size())
            return fail("its trace has node " + std::to_string(row.node) + ", and it has " +
                        std::to_string(nodes.size()) + " nodes");
        if (row.frame <= skip || row.frame > last) continue;
        Frame& frame = frames[row.rank][row.frame];
        frame.pack = cost.pack;
        frame.send += row.link * cost.send_byte + cost.send_message;
        frame.messages.push_back(message_of(row, NodeIndex(nodes[row.node]), cost));
    }
    std::vector<Member> members;
    for (std::size_t rank = 0; rank < hosts.size(); ++rank) {
        Member member{.host = hosts[rank], .frames = {}};
        for (auto& [number, frame] : frames[rank]) member.frames.push_back(std::move(frame));
        if (member.frames.empty()) return fail("its trace has no frames of rank " + std::to_string(rank));
        members.push_back(std::move(member));
    }
    return members;
}

Result<Scene> scene_of(const json& file, const std::filesystem::path& folder) {
    Scene scene;
    for (const json& group : file.at("hosts")) {
        Host host{.processors = group.value("processors", 1.0),
                  .up = group.value("up", kUnlimited),
                  .down = group.value("down", kUnlimited),
                  .runs_on = {}};
        if (group.contains("runs_on")) host.runs_on = group["runs_on"].get<std::uint32_t>();
        scene.hosts.insert(scene.hosts.end(), group.value("count", std::size_t{1}), host);
    }
    for (const auto host : file.at("nodes").get<std::vector<std::uint32_t>>()) scene.nodes.push_back(host);
    scene.latency = file.value("latency", scene.latency);
    scene.frames = file.value("frames", scene.frames);
    scene.warm_up = file.value("warm_up", scene.warm_up);
    scene.piece = file.value("piece", scene.piece);
    std::map<std::string, std::vector<Row>> traces;
    for (const json& program : file.at("programs")) {
        const auto name = program.at("trace").get<std::string>();
        const std::string where = "program " + std::to_string(scene.programs.size()) + ": ";
        auto known = traces.find(name);
        if (known == traces.end()) {
            auto rows = read_trace((folder / name).string());
            if (!rows) return tl::unexpected(rows.error());
            known = traces.emplace(name, std::move(*rows)).first;
        }
        auto members = members_of(program, known->second);
        if (!members) return fail(where + members.error().message);
        scene.programs.push_back({.members = std::move(*members), .ahead = program.value("ahead", 2u)});
    }
    return scene;
}

}  // namespace

Result<Scene> read_scene(const std::string& file) {
    std::ifstream in(file);
    if (!in) return fail(file + ": cannot be read");
    try {
        auto scene = scene_of(json::parse(in), std::filesystem::path(file).parent_path());
        if (!scene) return fail(file + ": " + scene.error().message);
        return scene;
    } catch (const json::exception& wrong) {
        return fail(file + ": " + wrong.what());
    }
}

}  // namespace wall::simulate
