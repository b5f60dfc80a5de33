// SPDX-License-Identifier: MIT
// wallplay: shows what `wallctl record --commands` has recorded, on any wall.
#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdlib>
#include <iostream>

#include "tools/wallplay/info.h"
#include "tools/wallplay/player.h"

namespace {

using namespace wall;
using namespace wall::wallplay;

std::atomic<bool> stop = false;

struct Arguments {
    PlayOptions play;
    std::string walld, name;
    std::vector<int> rect;
    bool fullscreen = false, info = false, as_json = false;
};

void add_options(CLI::App& app, Arguments& a) {
    app.add_option("FILE", a.play.file)->required();
    auto* from = app.add_option("--from", a.play.from, "seconds from the recording's beginning (0)")
                     ->check(CLI::NonNegativeNumber);
    app.add_option("--frame", a.play.from_frame, "the first frame that is shown, from 1, instead of --from")
        ->check(CLI::PositiveNumber)
        ->excludes(from);
    app.add_option("--frames", a.play.frames, "ends after so many frames")->check(CLI::PositiveNumber);
    app.add_option("--speed", a.play.speed, "2 is twice as fast (1)")->check(CLI::Range(0.01, 100.0));
    auto* loop = app.add_flag("--loop", a.play.loop, "begins anew at the end");
    app.add_flag("--stay", a.play.stay, "the last picture stays until it is closed (Ctrl-C, wallctl close)")
        ->excludes(loop);
    app.add_flag("--info", a.info, "says what is in the recording, and shows nothing");
    app.add_flag("--json", a.as_json, "JSON instead of text");
    app.add_option("--walld", a.walld, "where walld is: unix:PATH or HOST:PORT (WALLGL_WALLD)")->type_name("ADDR");
    auto* rect = app.add_option("--rect", a.rect, "where on the canvas the window goes (WALLGL_RECT)")
                     ->delimiter(',')
                     ->expected(4)
                     ->type_name("X,Y,W,H");
    app.add_flag("--fullscreen", a.fullscreen, "on the whole canvas")->excludes(rect);
    app.add_option("--name", a.name, "of the session, for people and layouts (WALLGL_NAME)");
}

/// It is a program of the wall as others are: they are told so.
void set_environment(const Arguments& a) {
    const auto set = [](const char* name, const std::string& value) {
        if (!value.empty()) ::setenv(name, value.c_str(), 1);
    };
    set("WALLGL_WALLD", a.walld);
    set("WALLGL_NAME", a.name);
    set("WALLGL_RECT", a.fullscreen ? "fullscreen" : fmt::format("{}", fmt::join(a.rect, ",")));
}

Result<void> show_info(const Arguments& a) {
    const auto named = [&](const Error& error) { return fail(a.play.file + ": " + error.message); };
    auto source = recording::Source::open(a.play.file);
    if (!source) return named(source.error());
    const std::uint64_t bytes = source->size;
    const auto reader = recording::Reader::open(std::move(*source));
    if (!reader) return named(reader.error());
    const auto info = info_json(*reader, bytes);
    std::cout << (a.as_json ? info.dump(2) + "\n" : info_text(info));
    return {};
}

Result<void> play(const Arguments& a) {
    set_environment(a);
    const auto session = client::ClientSession::get();
    if (!session) return fail("there is no wall to play it on");
    ::signal(SIGINT, [](int) { stop = true; });
    ::signal(SIGTERM, [](int) { stop = true; });
    auto played = Player(*session, a.play, stop).play();
    if (!played) return tl::unexpected(played.error());
    session->finish();
    if (a.as_json) {
        nlohmann::json out{{"frames", played->frames}};
        if (!played->skipped.empty()) out["skipped"] = played->skipped;
        std::cout << out.dump(2) << '\n';
    } else if (!played->skipped.empty()) {
        std::cerr << "wallplay: " << a.play.file << " is not whole: " << played->skipped << '\n';
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("wallplay: shows what `wallctl record --commands` has recorded, on any wall.");
    app.footer(
        "Examples:\n  wallplay flight.wgl\n  wallplay flight.wgl --from 90 --speed 0.5\n  wallplay flight.wgl --frame "
        "1200 --frames 1 --stay\n  wallplay --info flight.wgl\n\nExit code: 0; 1 if it cannot be played.");
    Arguments arguments;
    app.set_version_flag("--version", WALLGL_VERSION);
    add_options(app, arguments);
    CLI11_PARSE(app, argc, argv);
    const auto done = arguments.info ? show_info(arguments) : play(arguments);
    if (done) return 0;
    std::cerr << "wallplay: " << done.error().message << '\n';
    return 1;
}
