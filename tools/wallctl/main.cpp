// SPDX-License-Identifier: MIT
// wallctl: what an operator does. Tables for people, --json for programs.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>

#include "common/base/stereo.h"
#include "common/join/join.h"
#include "common/net/address.h"
#include "tools/request/request.h"
#include "tools/wallctl/bandwidth.h"
#include "tools/wallctl/doctor.h"
#include "tools/wallctl/record.h"
#include "tools/wallctl/record_commands.h"
#include "tools/wallctl/tables.h"
#include "tools/wallctl/take.h"
#include "tools/wallctl/watch.h"

namespace {

using namespace wall;
using namespace wall::wallctl;
using nlohmann::json;
using request::ask;
using request::failed;

constexpr const char* kNode = "node";
constexpr const char* kSaid = "said";               // code of a failure of which the JSON has been printed
constexpr std::chrono::seconds kLimit{10};          // for an answer
constexpr std::chrono::seconds kPictureLimit{120};  // it may wait in line, and a large one takes long to encode
constexpr std::chrono::seconds kCloseLimit{
    65};                                        // a program that is asked to close may take as long as wall.toml allows
constexpr std::chrono::seconds kMoveLimit{40};  // what was drawn comes back from the nodes first
constexpr std::chrono::seconds kWaitSlack{2};   // on top of what walld itself waits

struct Options {
    Walld walld{net::kDefaultWalld, {}};
    bool as_json = false, bandwidth = false;
    std::string id, tile, file, name;
    std::string role, at, line, state, node;
    int x = 0, y = 0, width = 0, height = 0;
    int frames = 1, frame = 1, weight = 0;
    double separation = 100 * wall::kUsualSeparation, distance = 0;
    unsigned fps = 10;
    double seconds = 10, interval = 1, snapshot = 10, until_back = 0;
    std::uint64_t count = 0;
    bool off = false, of_output = false, inverted = false;
    std::string axis = "x";
    std::vector<std::string> rest;  ///< of the command line, for another program
    int bit = 0;
};

/// What main() runs in the end; set by the verb that was given.
using Action = std::function<Outcome<void>()>;

std::string (*const kNoTable)(const json&) = nullptr;

Outcome<void> print(const Options& options, const Outcome<Answer>& answer, std::string (*table)(const json&)) {
    if (!answer) return tl::unexpected(answer.error());
    if (options.as_json) std::cout << answer->json.dump(2) << '\n';
    else if (table) std::cout << table(answer->json);
    return {};
}

Action show(const Options& options, const char* verb, std::string (*table)(const json&)) {
    return [&options, verb, table] { return print(options, ask(options.walld, verb, json::object(), kLimit), table); };
}

Action tell(const Options& options, const char* verb, std::function<json()> arguments,
            std::chrono::milliseconds limit = kLimit) {
    return [&options, verb, arguments, limit] {
        return print(options, ask(options.walld, verb, arguments(), limit), kNoTable);
    };
}

json pattern_arguments(const Options& options) {
    json out{{"kind", options.name}};
    if (!options.tile.empty()) out["tile"] = options.tile;
    if (options.of_output) out["output"] = true;
    if (options.name == "code")
        out.update({{"bit", options.bit}, {"axis", options.axis}, {"inverted", options.inverted}});
    return out;
}

/// By the program for it, which lies beside this one.
Outcome<void> calibrate_with(const Options& options) {
    std::error_code error;
    const auto program =
        (std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "wallcalibrate").string();
    std::vector<std::string> words{program, "--walld", options.walld.address};
    if (!options.walld.token_file.empty()) words.insert(words.end(), {"--token-file", options.walld.token_file});
    words.insert(words.end(), options.rest.begin(), options.rest.end());
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execv(program.c_str(), arguments.data());
    return failed(program + ": " + std::strerror(errno));
}

Outcome<void> screenshot(const Options& options) {
    json arguments = json::object();
    if (!options.tile.empty()) arguments["tile"] = options.tile;
    if (!options.id.empty()) arguments["id"] = options.id;
    if (options.of_output) arguments["output"] = true;
    const auto answer = ask(options.walld, "screenshot", arguments, kPictureLimit);
    if (!answer) return tl::unexpected(answer.error());
    std::ofstream file(options.file, std::ios::binary);
    file << answer->blob;
    if (!file.flush()) return failed(options.file + ": cannot be written");
    return print(options, answer, kNoTable);
}

Outcome<void> record(const Options& options) {
    if (!options.id.empty())
        return print(options,
                     record_commands(options.walld,
                                     {options.file, options.id, options.seconds, options.snapshot, !options.as_json}),
                     kNoTable);
    const auto recorded = wallctl::record(
        options.walld, {options.file, options.tile, options.seconds, options.fps, options.of_output, !options.as_json});
    return print(options, recorded, kNoTable);
}

Outcome<void> watch(const Options& options) {
    return wallctl::watch(options.walld, {std::chrono::milliseconds(static_cast<std::int64_t>(options.interval * 1000)),
                                          options.count, options.as_json});
}

Outcome<void> wait(const Options& options) {
    const auto limit = std::chrono::milliseconds(static_cast<std::int64_t>(options.seconds * 1000));
    const json arguments{{"id", options.id}, {"frame", options.frame}, {"timeout_ms", limit.count()}};
    return print(options, ask(options.walld, "wait", arguments, limit + kWaitSlack), kNoTable);
}

Outcome<void> doctor(const Options& options) {
    std::error_code error;
    json out = json::array();
    bool good = true;
    const auto say = [&](const Finding& finding) {
        constexpr const char* kWords[] = {"ok", "note", "WRONG"};  // in the order of Verdict
        const char* word = kWords[static_cast<int>(finding.verdict)];
        const bool bad = finding.verdict == Verdict::wrong;
        good = good && !bad;
        out.push_back({{"check", finding.check}, {"good", !bad}, {"verdict", word}, {"detail", finding.detail}});
        if (!options.as_json)
            std::cout << fmt::format("{:5} {}: {}\n", word, finding.check, finding.detail) << std::flush;
    };
    for (const auto& finding : examine(options.walld, std::filesystem::read_symlink("/proc/self/exe", error).string()))
        say(finding);
    if (options.bandwidth) {
        const auto status = ask(options.walld, "status", json::object(), kLimit);
        const auto measured = measure_ways(
            options.walld, [&](const Way& way) { say(way_finding(way, status ? status->json : json::object())); });
        if (!measured) say({"bandwidth", Verdict::wrong, measured.error().message});
    }
    if (options.as_json) std::cout << out.dump(2) << '\n';
    if (!good) return tl::unexpected<Failure>({kSaid, "something is wrong, see above"});
    return {};
}

void add_id(CLI::App* verb, Options& options) {
    verb->add_option("ID", options.id, "session, or SESSION.SURFACE, as `wallctl sessions` shows it")->required();
}

/// wallctl layout save|load|list|delete
void add_layouts(CLI::App& app, Options& o, Action& action) {
    auto* layout = app.add_subcommand("layout", "keeps where windows are, by the names of programs");
    layout->require_subcommand(1)->fallthrough();
    const auto verb = [&](const char* name, const char* about, Action run) {
        auto* sub = layout->add_subcommand(name, about);
        sub->callback([&action, run] { action = run; });
        sub->fallthrough();
        return sub;
    };
    const auto named = [&](const char* name, const char* wire, const char* about, std::string (*text)(const json&)) {
        auto* sub = verb(name, about, [&o, wire, text] {
            return print(o, ask(o.walld, wire, json{{"name", o.name}}, kLimit), text);
        });
        sub->add_option("NAME", o.name, "letters, digits, dots, dashes, underscores")->required();
    };
    verb("list", "the layouts there are", show(o, "layouts", names_text));
    named("save", "save_layout", "keeps the places of all windows", kNoTable);
    named("load", "load_layout", "brings windows back to their places", placed_text);
    named("delete", "delete_layout", "forgets a layout", kNoTable);
}

/// Units look for what they are in these folders.
std::string state_of(const Options& options) {
    if (!options.state.empty()) return options.state;
    return "/var/lib/wallgl/" + (options.node.empty() ? "agent" : options.node);
}

Outcome<void> join_wall(const Options& options) {
    const auto line = tls::JoinLine::parse(options.line);
    if (!line) return failed(line.error().message);
    const auto kind = options.node.empty() ? join::MachineKind::client : join::MachineKind::node;
    const auto joined = join::join(*line, kind, state_of(options));
    if (!joined) return failed(joined.error().message);
    const std::string unit = options.node.empty() ? "wallagent" : "tileserver-joined@" + options.node;
    const json told{{"name", joined->name}, {"walld", joined->walld.text()}, {"unit", unit}};
    if (options.as_json) std::cout << told.dump(2) << '\n';
    else
        std::cout << "joined the wall at " << joined->walld.text() << " as '" << joined->name << "', "
                  << (options.node.empty() ? "to bring programs there" : "to draw its tiles")
                  << ": systemctl enable --now " << unit << '\n';
    return {};
}

Outcome<void> add_node(const Options& options) {
    std::ostringstream text;
    std::ifstream file(options.file, std::ios::binary);
    if (options.file == "-") text << std::cin.rdbuf();
    else text << file.rdbuf();
    if (options.file != "-" && !file) return failed(options.file + ": cannot be read");
    return print(options, ask(options.walld, "add_node", json{{"toml", text.str()}}, kLimit), reloaded_text);
}

/// wallctl node add|remove|drain|undrain
template <class Verb>
void add_node_verbs(CLI::App& group, const Verb& verb, Options& o) {
    verb(group, "add", "adds a node to the wall while it runs, until `remove`", [&o] { return add_node(o); })
        ->add_option("FILE", o.file, "its [[node]] table, as in wall.toml; - for standard input")
        ->required();
    const auto named = [&](const char* name, const char* wire, const char* about) {
        auto* sub = verb(group, name, about, [&o, wire] {
            return print(o, ask(o.walld, wire, json{{"name", o.name}}, kLimit), kNoTable);
        });
        sub->add_option("NAME", o.name, "as `wallctl nodes` shows it")->required();
    };
    named("remove", "remove_node", "takes a node away that `add` has added");
    named("drain", "drain_node", "programs leave the node, so that its machine can be stopped; its tiles go dark");
    named("undrain", "undrain_node", "programs use the node again");
}

/// wallctl join-token, machines, node, client, join: walls of several machines
void add_machines(CLI::App& app, Options& o, Action& action) {
    const auto verb = [&action](CLI::App& parent, const char* name, const char* about, Action run) {
        auto* sub = parent.add_subcommand(name, about);
        sub->callback([&action, run] { action = run; });
        sub->fallthrough();
        return sub;
    };
    const auto ask_about = [&o](const char* wire, const char* kind, std::string (*text)(const json&)) {
        return Action([&o, wire, kind, text] {
            const json arguments{{"kind", kind}, {"name", o.name}, {"role", o.role}, {"address", o.at}};
            return print(o, ask(o.walld, wire, arguments, kLimit), text);
        });
    };
    auto* token = app.add_subcommand("join-token", "prints the command with which another machine joins the wall");
    token->require_subcommand(1)->fallthrough();
    token->add_option("--address", o.at, "where that machine reaches walld, HOST:PORT, if it listens on all addresses");
    verb(*token, "node", "a render node", ask_about("join_token", "node", invitation_text))
        ->add_option("NAME", o.name, "of its [[node]] in wall.toml")
        ->required();
    auto* client = verb(*token, "client", "a machine whose people start programs on the wall",
                        ask_about("join_token", "client", invitation_text));
    client->add_option("NAME", o.name, "what the wall shall call it (its host name)");
    client->add_option("--role", o.role, "of its people: viewer, user or operator (user)");
    for (const char* kind : {kNode, "client"}) {
        auto* group =
            app.add_subcommand(kind, kind == kNode ? "the wall's nodes, and the machines that have joined as such"
                                                   : "the machines that have joined as client hosts");
        group->require_subcommand(1)->fallthrough();
        verb(*group, "list", "those that have joined", [&o, kind] {
            auto answer = ask(o.walld, "machines", json::object(), kLimit);
            json of_kind = json::array();
            for (const auto& machine : answer ? answer->json : json::array())
                if (machine.value("kind", "") == kind) of_kind.push_back(machine);
            if (answer) answer->json = std::move(of_kind);
            return print(o, answer, machines_table);
        });
        verb(*group, "revoke", "ends its connections, and lets it in no more", ask_about("revoke", kind, kNoTable))
            ->add_option("NAME", o.name)
            ->required();
        if (kind == kNode) add_node_verbs(*group, verb, o);
    }
    auto* tokens = app.add_subcommand("token", "the secrets that stand for people ([[people.token]] in wall.toml)");
    tokens->require_subcommand(1)->fallthrough();
    verb(*tokens, "list", "the tokens, and which are revoked", show(o, "tokens", tokens_table));
    verb(*tokens, "revoke",
         "takes it from whoever has it: its programs end, and it is good for nothing until it has another secret",
         [&o] {
             return print(o, ask(o.walld, "revoke_token", json{{"name", o.name}}, kLimit), revoked_text);
         })
        ->add_option("NAME", o.name)
        ->required();
    verb(app, "reload", "reads wall.toml again: nodes and tiles come, move and go while programs run",
         show(o, "reload", reloaded_text));
    verb(app, "machines", "all machines that have joined", show(o, "machines", machines_table));
    auto* join = verb(app, "join", "joins a wall of another machine, with a line of `wallctl join-token`",
                      [&o] { return join_wall(o); });
    join->add_option("LINE", o.line)->required();
    join->add_option("--node", o.node, "NAME: as this node, not as a client host");
    join->add_option("--state", o.state, "where the key is kept (/var/lib/wallgl/agent, or /var/lib/wallgl/NAME)");
}

void add_verbs(CLI::App& app, Options& o, Action& action) {
    const auto verb = [&](const char* name, const char* about, Action run) {
        auto* sub = app.add_subcommand(name, about);
        sub->callback([&action, run] { action = run; });
        sub->fallthrough();
        return sub;
    };
    const auto with_id = [&o] { return json{{"id", o.id}}; };
    verb("status", "the wall, its nodes and programs", show(o, "status", status_text));
    verb("nodes", "the nodes", show(o, "nodes", nodes_table));
    verb("tiles", "the tiles and their places", show(o, "tiles", tiles_table));
    verb("sessions", "the programs on the wall and their windows", show(o, "sessions", sessions_table));
    verb("streams", "what is watched live, part by part", show(o, "streams", streams_table));
    auto* watching = verb(
        "watch", "tiles, programs and streams, refreshed in place; Ctrl-C ends it. With --json a line for each refresh",
        [&o] { return watch(o); });
    watching->add_option("--interval", o.interval, "seconds (1)")->check(CLI::Range(0.1, 3600.0));
    watching->add_option("--count", o.count, "refreshes, then it ends")->check(CLI::PositiveNumber);
    auto* place = verb("place", "puts a window on a rectangle of the wall", tell(o, "place", [&o] {
                           return json{{"id", o.id}, {"rect", {o.x, o.y, o.width, o.height}}};
                       }));
    add_id(place, o);
    place->add_option("X", o.x)->required();
    place->add_option("Y", o.y)->required();
    place->add_option("W", o.width)->required();
    place->add_option("H", o.height)->required();
    add_id(verb("raise", "puts a window before all others", tell(o, "raise", with_id)), o);
    add_id(verb("lower", "puts a window behind all others", tell(o, "lower", with_id)), o);
    add_id(verb("close", "asks a program to close; one that does not in time is cut off",
                tell(o, "close", with_id, kCloseLimit)),
           o);
    auto* shot = verb("screenshot", "writes what the wall shows as PNG", [&o] { return screenshot(o); });
    shot->add_option("FILE", o.file)->required();
    auto* of_tile = shot->add_option("--tile", o.tile, "only this tile");
    auto* of_program = shot->add_option("--session", o.id, "only this program");
    shot->add_flag("--output", o.of_output, "as the tile's monitor or projector gets it: turned, warped, blended")
        ->needs(of_tile)
        ->excludes(of_program);
    auto* recording = verb("record",
                           "writes what the wall shows as AVI, without loss (HuffYUV), or what a program draws as "
                           "commands, for wallplay; Ctrl-C ends it early",
                           [&o] { return record(o); });
    recording->add_option("FILE", o.file)->required();
    recording->add_option("--seconds", o.seconds, "how long (10)")->check(CLI::Range(0.1, 86400.0));
    auto* recorded_fps = recording->add_option("--fps", o.fps, "frames a second (10)")->check(CLI::Range(1, 60));
    auto* recorded_tile = recording->add_option("--tile", o.tile, "only this tile");
    auto* commands = recording
                         ->add_option("--commands", o.id,
                                      "the commands of this session, instead of pictures: wallplay shows them on any "
                                      "wall")
                         ->type_name("ID")
                         ->excludes(recorded_tile)
                         ->excludes(recorded_fps);
    recording->add_option("--snapshot", o.snapshot, "of commands: seconds between places where playing can begin (10)")
        ->check(CLI::Range(0.1, 86400.0))
        ->needs(commands);
    recording->add_flag("--output", o.of_output, "as the tile's monitor or projector gets it")->needs(recorded_tile);
    auto* pattern = verb("pattern", "shows test pictures instead of the programs, until `wallctl pattern off`",
                         tell(o, "pattern", [&o] { return pattern_arguments(o); }));
    pattern->add_option("KIND", o.name, "grid, ramps, names, white, black, code (a bit of a Gray code) or off")
        ->required();
    pattern->add_option("--tile", o.tile, "only this tile");
    pattern->add_flag("--output", o.of_output, "in the output's own pixels: not turned, warped or blended");
    pattern->add_option("--bit", o.bit, "of a code: 0 changes most often (0)");
    pattern->add_option("--axis", o.axis, "of a code: x tells columns, y rows (x)");
    pattern->add_flag("--inverted", o.inverted, "of a code: dark where it would be bright");
    auto* hold = verb("hold", "shows no further frame of a program until it is stepped", tell(o, "hold", [&o] {
                          return json{{"id", o.id}, {"on", !o.off}};
                      }));
    add_id(hold, o);
    hold->add_flag("--off", o.off, "lets it run again");
    auto* step = verb("step", "shows the next frames of a held program", tell(o, "step", [&o] {
                          return json{{"id", o.id}, {"frames", o.frames}};
                      }));
    add_id(step, o);
    step->add_option("N", o.frames, "how many (1)")->check(CLI::PositiveNumber);
    auto* weight =
        verb("weight", "a program's share of the nodes' time, beside those of the others", tell(o, "weight", [&o] {
                 return json{{"id", o.id}, {"weight", o.weight}};
             }));
    add_id(weight, o);
    weight->add_option("N", o.weight, "1 to 100; of a program of which nobody has said anything: 10")->required();
    auto* stereo =
        verb("stereo", "shows a program to two eyes, on tiles that are for one each", tell(o, "stereo", [&o] {
                 return json{{"id", o.id}, {"on", !o.off}, {"separation", o.separation}, {"distance", o.distance}};
             }));
    add_id(stereo, o);
    stereo->add_option("--separation", o.separation,
                       "of what is infinitely far, from one eye's picture to the other's: percent of the window's "
                       "width (1.5). On a large wall no more than eyes are apart, 65 mm; less than 0 swaps the eyes");
    stereo->add_option(
        "--distance", o.distance,
        "in the program's units: what is so far from its camera lies in the wall's plane, what is nearer "
        "comes out of it (0: the middle of what it draws)");
    stereo->add_flag("--off", o.off, "both eyes see the program's own picture again");
    auto* move = verb("move", "puts a program, with all that it has drawn, on another wall while it runs",
                      tell(
                          o, "move",
                          [&o] {
                              return json{{"id", o.id}, {"to", o.name}};
                          },
                          kMoveLimit));
    add_id(move, o);
    move->add_option("--to", o.name,
                     "the other wall: unix:PATH of its control socket (or of an agent of it) on the program's machine")
        ->required();
    auto* taking =
        verb("take", "puts a program into its own X window while it runs, until Ctrl-C puts it back on the wall", [&o] {
            return print(o, take(o.walld, {o.id, o.until_back, !o.as_json}), kNoTable);
        });
    add_id(taking, o);
    taking->add_option("--seconds", o.until_back, "puts it back after so long")->check(CLI::Range(0.1, 86400.0));
    auto* waiting = verb("wait", "returns when a frame is shown on all tiles", [&o] { return wait(o); });
    add_id(waiting, o);
    waiting->add_option("--frame", o.frame, "its number")->required()->check(CLI::PositiveNumber);
    waiting->add_option("--timeout", o.seconds, "seconds (10)")->check(CLI::Range(0.0, 600.0));
    verb("whoami", "as whom walld sees you, and your role", show(o, "whoami", person_text));
    add_layouts(app, o, action);
    add_machines(app, o, action);
    auto* calibrate = verb("calibrate", "finds projectors' places with a camera, and writes warps and blends (--help)",
                           [&o] { return calibrate_with(o); });
    calibrate->fallthrough(false);
    calibrate->prefix_command();
    calibrate->set_help_flag();
    calibrate->callback([&action, &o, calibrate] {
        o.rest = calibrate->remaining();
        action = [&o] { return calibrate_with(o); };
    });
    auto* doctors = verb("doctor", "looks for what usually goes wrong", [&o] { return doctor(o); });
    doctors->add_flag("--bandwidth", o.bandwidth,
                      "also measures how fast programs of this machine reach each node: full load for half a second "
                      "each");
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("wallctl: everything an operator does with a wall.");
    app.footer(
        "Examples:\n  wallctl status\n  wallctl --json sessions\n  wallctl watch\n  wallctl screenshot wall.png\n  "
        "wallctl record wall.avi --seconds 30\n  wallctl place 3 0 0 1920 1080\n"
        "  wallctl --walld 127.0.0.1:7770 nodes\n\nExit code: 0; 1 if walld says no or cannot be reached.");
    Options options;
    Action action;
    if (const char* walld = std::getenv("WALLGL_WALLD"); walld && *walld) options.walld.address = walld;
    if (const char* token = std::getenv("WALLGL_TOKEN_FILE"); token) options.walld.token_file = token;
    app.add_option("--walld", options.walld.address, "where walld is: unix:PATH or HOST:PORT (WALLGL_WALLD)")
        ->type_name("ADDR");
    app.add_option("--token-file", options.walld.token_file, "asks as the token in this file (WALLGL_TOKEN_FILE)")
        ->type_name("FILE");
    app.add_flag("--json", options.as_json, "JSON instead of tables");
    app.set_version_flag("--version", WALLGL_VERSION);
    app.require_subcommand(1);
    add_verbs(app, options, action);
    CLI11_PARSE(app, argc, argv);
    try {
        if (const auto done = action(); !done) {
            std::cerr << "wallctl: " << done.error().message << '\n';
            if (options.as_json && done.error().code != kSaid)
                std::cout << json{{"error", {{"code", done.error().code}, {"message", done.error().message}}}}.dump(2)
                          << '\n';
            return 1;
        }
    } catch (const std::exception& error) {
        std::cerr << "wallctl: unexpected answer: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
