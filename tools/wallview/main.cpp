// SPDX-License-Identifier: MIT
// wallview: the wall, a tile or a program live in a window of this desktop.
#define SDL_MAIN_HANDLED
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "tools/wallview/viewer.h"

namespace {

using namespace wall;
using nlohmann::json;

struct Arguments {
    view::Walld walld{net::kDefaultWalld, {}};
    std::string http, tile, session, codec = "huffyuv-tiles";
    std::vector<int> region, size{960, 540};
    unsigned fps = 30;
    wallview::Options options;
};

/// "3" or "3.1"
json session_entry(const std::string& id) {
    const auto dot = id.find('.');
    json out{{"session", std::stoul(id)}};
    if (dot != std::string::npos) out["surface"] = std::stoul(id.substr(dot + 1));
    return out;
}

void complete(Arguments& a) {
    auto& what = a.options.what;
    what = !a.session.empty() ? session_entry(a.session)
           : !a.tile.empty()  ? json{{"tile", a.tile}}
                              : json{{"wall", true}};
    if (!a.region.empty()) what["region"] = a.region;
    what["codec"] = a.codec;
    what["fps"] = a.fps;
    a.options.title = "WallGL: " + (!a.session.empty() ? "program " + a.session
                                    : !a.tile.empty()  ? "tile " + a.tile
                                                       : "the wall");
    a.options.size = {a.size[0], a.size[1]};
}

void add_options(CLI::App& app, Arguments& a) {
    if (const char* walld = std::getenv("WALLGL_WALLD"); walld && *walld) a.walld.address = walld;
    if (const char* token = std::getenv("WALLGL_TOKEN_FILE"); token) a.walld.token_file = token;
    auto* walld = app.add_option("--walld", a.walld.address, "where walld is: unix:PATH or HOST:PORT (WALLGL_WALLD)")
                      ->type_name("ADDR");
    app.add_option("--http", a.http, "its HTTP server instead, through a WebSocket: http://HOST[:PORT]")
        ->type_name("URL")
        ->excludes(walld);
    app.add_option("--token-file", a.walld.token_file, "asks as the token in this file (WALLGL_TOKEN_FILE)")
        ->type_name("FILE");
    auto* tile = app.add_option("--tile", a.tile, "only this tile");
    auto* session =
        app.add_option("--session", a.session, "a program's window, wherever it is: session, or SESSION.SURFACE")
            ->check(CLI::Validator(
                [](std::string& id) {
                    return id.find_first_not_of("0123456789.") == std::string::npos && id.front() != '.' &&
                                   id.back() != '.' && std::ranges::count(id, '.') <= 1 && id.size() < 20
                               ? std::string()
                               : "'" + id + "' is no session";
                },
                "ID"))
            ->excludes(tile);
    app.add_option("--region", a.region, "a part of the wall, or of the tile, in its pixels")
        ->delimiter(',')
        ->expected(4)
        ->type_name("X,Y,W,H")
        ->excludes(session);
    app.add_option("--codec", a.codec, "between nodes and here (huffyuv-tiles); docs/codecs.md has their names");
    app.add_option("--fps", a.fps, "pictures a second, at most (30)")->check(CLI::Range(1, 60));
    app.add_option("--size", a.size, "of the window (960x540)")
        ->delimiter('x')
        ->expected(2)
        ->type_name("WxH")
        ->check(CLI::Range(16, 32768));
    app.add_flag("--fullscreen", a.options.fullscreen, "begins on the whole screen");
    app.add_option("--frames", a.options.frames, "ends after so many pictures")->check(CLI::PositiveNumber);
    app.add_option("--save", a.options.save, "writes the last picture there in the end")->type_name("FILE.png");
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("wallview: the wall, live, in a window of this desktop.");
    app.footer(
        "Keys: F or a double click: full screen; S: saves the picture; Q or Escape: ends.\n\nExamples:\n  wallview\n  "
        "wallview --session 3 --fullscreen\n"
        "  wallview --tile left --region 0,0,640,480\n  wallview --http http://localhost:7780\n  wallview --frames 1 "
        "--save wall.png\n\n"
        "SDL_RENDER_DRIVER=software draws without OpenGL. Exit code: 0; 1 if there is no window, or no picture for "
        "--frames.");
    Arguments arguments;
    app.set_version_flag("--version", WALLGL_VERSION);
    add_options(app, arguments);
    CLI11_PARSE(app, argc, argv);
    complete(arguments);
    const auto connect = [&arguments](const json& entry) {
        const auto watch = json::array({entry});
        return arguments.http.empty() ? view::open_control_feed(arguments.walld, watch)
                                      : view::open_web_feed(arguments.http, arguments.walld.token_file, watch);
    };
    SDL_SetMainReady();
    if (const auto done = wallview::run(connect, arguments.options); !done) {
        std::cerr << "wallview: " << done.error().message << '\n';
        return 1;
    }
    return 0;
}
