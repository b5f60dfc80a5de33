// SPDX-License-Identifier: MIT
// wallrun: starts an unmodified OpenGL program on the wall. Checks first, because GLVND says nothing when it falls
// back.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <vector>

#include "tools/wallrun/launch.h"
#include "tools/wallrun/members.h"

namespace {

using namespace wall;
using namespace wall::wallrun;

constexpr int kExitNotStarted = 2;  // ours: nothing was started
constexpr int kExitNotFound = 127;  // as a shell says it

constexpr const char* kAbout =
    "wallrun: starts an OpenGL program on the wall.\n\n"
    "The program needs no change. Its window keeps its own size; on the wall it is placed pixel by pixel where there "
    "is\n"
    "room, or, with --rect or --fullscreen, drawn anew at the size given there. It still needs an X display for its\n"
    "window and its input (Xvfb will do).";
constexpr const char* kExamples =
    "Examples:\n"
    "  wallrun -- glxgears\n"
    "  wallrun --fullscreen -- glxgears                 over the whole wall, at the wall's resolution\n"
    "  wallrun --rect 0,0,1920,1080 --name left -- PROGRAM ARGUMENTS\n"
    "  wallrun --parallel 4 -- PROGRAM                  four processes draw into one window "
    "(docs/parallel-programs.md)\n"
    "  mpirun -n 4 wallrun --parallel-group NAME -- PROGRAM   the same, started by MPI\n"
    "  wallrun --walld 127.0.0.1:7770 -- PROGRAM        a walld elsewhere than ";
constexpr const char* kExits =
    "\n\nEnvironment: WALLGL_WALLD (as --walld), WALLGL_LOG=debug|info|warn, WALLGL_STATS=FILE (counters as JSON).\n"
    "Exit code: the program's own; 2 if it was not started, 127 if it is not found. With --parallel the first one that "
    "is\n"
    "not 0 (128 + the signal, if one ended it); the other processes are ended then.";

[[noreturn]] void give_up(const Error& error) {
    std::cerr << "wallrun: " << error.message << '\n';
    std::exit(kExitNotStarted);
}

std::string from_environment(const char* name, const char* otherwise = "") {
    const char* value = std::getenv(name);
    return value && *value ? value : otherwise;
}

VendorFiles checked_vendor() {
    std::error_code error;
    auto files = find_vendor(std::filesystem::read_symlink("/proc/self/exe", error).string());
    if (!files) give_up(files.error());
    if (auto good = check_vendor(*files); !good) give_up(good.error());
    return *files;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(kAbout);
    app.footer(std::string(kExamples) + net::kDefaultWalld + kExits);
    Launch launch;
    launch.walld = from_environment("WALLGL_WALLD", net::kDefaultWalld);
    std::vector<std::string> command;
    bool fullscreen = false;
    std::uint32_t parallel = 0;
    std::string group;
    app.add_option("--walld", launch.walld, "where walld is: unix:PATH or HOST:PORT")->type_name("ADDR");
    auto* rect = app.add_option("--rect", launch.rect, "the first window covers this part of the wall, in pixels")
                     ->type_name("X,Y,W,H");
    app.add_flag("--fullscreen", fullscreen, "the first window covers the whole wall")->excludes(rect);
    app.add_option("--name", launch.name, "what wallctl and the status page call it");
    app.add_flag("--hold", launch.hold, "frames are shown only on `wallctl step` (to look at one after the other)");
    app.add_option(
           "--stereo", launch.stereo,
           "for two eyes, on tiles that are for one each: how far what is infinitely far is apart, in percent of "
           "the window's width, and from which distance of the program's camera on, in its units, things lie "
           "behind the wall (as `wallctl stereo` has it)")
        ->type_name("PERCENT[,DISTANCE]");
    app.add_option("--camera", launch.camera,
                   "for tiles that look elsewhere or are for one eye: the uniform in which the program's shaders have "
                   "their projection, or projection and view, where that is not found in them")
        ->type_name("NAME[,NAME...]");
    app.add_flag(
        "--sort-last", launch.sort_last,
        "its geometry may be dealt to the wall's nodes, each of which draws a part of it, and their pictures be "
        "put together by depth: for programs that have more geometry than one node can draw");
    app.add_option(
           "--lossy-pixels", launch.lossy_pixels,
           "vertices may lie so far from where they belong, in pixels of the wall, which makes the stream smaller: at "
           "most what the wall allows. 0: nothing is lost. Without it the wall decides, and nothing is lost where "
           "links are fast")
        ->type_name("PIXELS");
    auto* processes =
        app.add_option("--parallel", parallel, "a parallel program: so many processes draw into its windows together")
            ->type_name("N");
    app.add_option(
           "--parallel-group", group,
           "this is one process of a parallel program that mpirun starts; a name that no other one on the wall has")
        ->type_name("NAME")
        ->excludes(processes);
    app.add_option("command", command, "the program and its arguments, after --")->required()->type_name("");
    app.set_version_flag("--version", WALLGL_VERSION);
    app.prefix_command(false);
    CLI11_PARSE(app, argc, argv);

    if (fullscreen) launch.rect = "fullscreen";
    if (auto good = check_rect(launch.rect); !good) give_up(good.error());
    const bool of_many = parallel > 0 || !group.empty();
    if (auto good = check_stereo(launch.stereo, of_many); !good) give_up(good.error());
    if (auto good = check_camera(launch.camera); !good) give_up(good.error());
    if (auto good = check_lossy_pixels(launch.lossy_pixels); !good) give_up(good.error());
    if (*processes && parallel == 0) give_up({"--parallel: expected at least one process"});
    if (parallel > 0) group = new_group_name(command[0]);
    if (!group.empty()) {
        const auto member = parallel > 0 ? Result<MemberRank>({0, parallel})
                                         : rank_from_launcher([](const char* name) { return from_environment(name); });
        if (!member) give_up(member.error());
        const auto value = parallel_value(group, *member);
        if (!value) give_up(value.error());
        ::setenv("WALLGL_PARALLEL", value->c_str(), 1);
    }
    const auto files = checked_vendor();
    if (auto good = check_walld(launch.walld); !good) give_up(good.error());
    for (const auto& [name, value] : environment_for(launch, files, from_environment("LD_LIBRARY_PATH")))
        ::setenv(name.c_str(), value.c_str(), 1);

    if (parallel > 0) return run_members(group, parallel, command);
    std::vector<char*> arguments;
    for (auto& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    std::cerr << "wallrun: " << command[0] << ": " << std::strerror(errno) << '\n';
    return errno == ENOENT ? kExitNotFound : kExitNotStarted;
}
