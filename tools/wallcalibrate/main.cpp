// SPDX-License-Identifier: MIT
// wallcalibrate: takes or reads photographs of Gray codes on each tile, finds where the projectors lie on a flat or a
// curved screen, and writes what wall.toml wants to know (docs/walls.md). `wallctl calibrate` is this program.
#include <sys/wait.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "common/base/whole_file.h"
#include "tools/request/request.h"
#include "tools/wallcalibrate/camera_lens.h"
#include "tools/wallcalibrate/curved_screen.h"
#include "tools/wallcalibrate/flat_screen.h"
#include "tools/wallcalibrate/gray_code.h"
#include "tools/wallcalibrate/wall_plan.h"

namespace {

using namespace wall;
using namespace wall::calibrate;
using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::chrono::seconds kLimit{30};  // for walld's answer
constexpr mode_t kMode = 0644;
constexpr int kMostCorners = 100;  // of a board, a side

struct Options {
    request::Walld walld{net::kDefaultWalld, {}};
    fs::path pictures, out = ".";
    std::string camera, capture;
    std::vector<std::string> tiles;
    double gamma = 2.2, settle = 0.5;
    bool curved = false;
    std::string lens;   // of the camera, a file
    std::string board;  // inner corners, such as 9x6
};

Result<json> ask(const Options& options, const std::string& verb, const json& arguments) {
    auto answer = request::ask(options.walld, verb, arguments, kLimit);
    if (!answer) return fail(answer.error().message);
    return std::move(answer->json);
}

/// A tile's name is a file's.
Result<void> check_name(const std::string& tile) {
    const auto good = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.' || c == ' '; };
    if (!tile.empty() && tile[0] != '.' && std::ranges::all_of(tile, good)) return {};
    return fail("tile '" + tile +
                "': its photographs are called after it: expected letters, digits, dots, dashes, "
                "underscores and blanks in its name");
}

Result<std::vector<Projector>> projectors_of(const Options& options) {
    const auto tiles = ask(options, "tiles", json::object());
    if (!tiles) return tl::unexpected(tiles.error());
    std::vector<Projector> out;
    for (const auto& tile : *tiles) {
        const auto name = tile.at("name").get<std::string>();
        if (!options.tiles.empty() && std::ranges::count(options.tiles, name) == 0) continue;
        if (auto good = check_name(name); !good) return tl::unexpected(good.error());
        const auto &rect = tile.at("rect"), &pixels = tile.at("pixels");
        out.push_back({name, {rect.at(0), rect.at(1), rect.at(2), rect.at(3)}, pixels.at(0), pixels.at(1), {}});
    }
    for (const auto& wanted : options.tiles)
        if (std::ranges::none_of(out, [&](const auto& p) { return p.tile == wanted; }))
            return fail("there is no tile '" + wanted + "'");
    return out;
}

fs::path file_of(const Options& options, const std::string& tile, const Shot& shot) {
    return options.pictures / (tile + "-" + shot.name() + ".png");
}

Result<void> show(const Options& options, const std::string& tile, const Shot& shot) {
    json pattern{{"tile", tile}, {"output", true}, {"kind", shot.kind == Shot::Kind::white ? "white" : "black"}};
    if (shot.kind == Shot::Kind::code)
        pattern.update(
            {{"kind", "code"}, {"bit", shot.bit}, {"axis", shot.rows ? "y" : "x"}, {"inverted", shot.inverted}});
    if (auto shown = ask(options, "pattern", pattern); !shown) return tl::unexpected(shown.error());
    return {};
}

/// As one word of a shell.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

/// By the command that was given, whose {} is the file.
Result<void> photograph(const Options& options, const fs::path& file) {
    std::string command = !options.capture.empty()
                              ? options.capture
                              : "ffmpeg -v error -y -f v4l2 -i " + quoted(options.camera) + " -frames:v 1 {}";
    const auto place = command.find("{}");
    if (place == std::string::npos) return fail("--capture: expected a command with {} where the file's name goes");
    command.replace(place, 2, quoted(file.string()));
    std::error_code error;
    fs::remove(file, error);
    const int status = std::system(command.c_str());
    if (status != 0 || !fs::exists(file, error))
        return fail("'" + command + "' " + (status != 0 ? "failed" : "wrote no such file"));
    return {};
}

Result<void> take_all(const Options& options, const std::vector<Projector>& projectors) {
    std::error_code error;
    fs::create_directories(options.pictures, error);
    if (error) return fail(options.pictures.string() + ": " + error.message());
    for (const auto& projector : projectors) {
        if (auto dark = ask(options, "pattern", {{"kind", "black"}, {"output", true}}); !dark)
            return tl::unexpected(dark.error());
        const auto shots = shots_of(projector.width, projector.height);
        for (std::size_t i = 0; i < shots.size(); ++i) {
            std::cerr << "\rtile " << projector.tile << ": photograph " << i + 1 << " of " << shots.size()
                      << std::flush;
            if (auto shown = show(options, projector.tile, shots[i]); !shown) return shown;
            std::this_thread::sleep_for(std::chrono::duration<double>(options.settle));
            if (auto taken = photograph(options, file_of(options, projector.tile, shots[i])); !taken) return taken;
        }
        std::cerr << '\n';
    }
    return {};
}

/// Whatever comes of it, the programs are shown again.
Result<void> take(const Options& options, const std::vector<Projector>& projectors) {
    auto taken = take_all(options, projectors);
    const auto shown = ask(options, "pattern", {{"kind", "off"}});
    if (!taken) return taken;
    return shown ? Result<void>() : tl::unexpected(shown.error());
}

Result<cv::Mat> read(const fs::path& file) {
    auto picture = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    if (picture.empty()) return fail(file.string() + ": cannot be read: expected a photograph");
    return picture;
}

Result<void> write(const Options& options, const std::vector<PlannedTile>& tiles) {
    std::error_code error;
    fs::create_directories(options.out, error);
    std::string lines =
        "# What `wallctl calibrate` found: put these keys into the tiles of wall.toml, the .warp files "
        "beside it, and\n# `wallctl reload`.\n";
    for (const auto& tile : tiles) {
        const auto name = tile.tile + ".warp";
        if (auto written = write_whole(options.out / name, warp_text(tile.warp), kMode); !written) return written;
        lines += "\n# [[node.tile]] name = \"" + tile.tile + "\"\n" + tile_lines(tile, name, options.gamma);
    }
    return write_whole(options.out / "tiles.toml", lines, kMode);
}

struct Photographed {
    cv::Size size;                            // of a photograph
    std::vector<std::vector<Match>> matches;  // of each projector
};

Result<Photographed> read_all(const Options& options, const std::vector<Projector>& projectors) {
    Photographed out;
    for (const auto& projector : projectors) {
        auto decoded = decode(projector.width, projector.height, [&](const Shot& shot) {
            auto picture = read(file_of(options, projector.tile, shot));
            if (picture && !out.size.empty() && picture->size() != out.size)
                return Result<cv::Mat>(fail("the photographs of tile '" + projector.tile + "' have another size"));
            if (picture) out.size = picture->size();
            return picture;
        });
        if (!decoded) return fail("tile '" + projector.tile + "': " + decoded.error().message);
        std::cerr << "tile " << projector.tile << ": " << decoded->size() << " pixels of the camera see it\n";
        out.matches.push_back(std::move(*decoded));
    }
    return out;
}

/// Pixels of a projector that 95 % of the matches are off by less.
Result<double> put_on_flat_screen(const Photographed& photographed, std::vector<Projector>& projectors) {
    const auto screen = find_flat_screen(photographed.size, photographed.matches);
    if (!screen) return tl::unexpected(screen.error());
    for (std::size_t i = 0; i < projectors.size(); ++i) projectors[i].on_screen = screen->from_output[i];
    return screen->error;
}

/// The same.
Result<double> put_on_curved_screen(const Options& options, const Photographed& photographed,
                                    std::vector<Projector>& projectors) {
    CameraLens lens;
    if (!options.lens.empty()) {
        auto known = read_lens(options.lens);
        if (!known) return tl::unexpected(known.error());
        lens = std::move(*known);
        const auto text = [](const cv::Size& size) {
            return std::to_string(size.width) + "x" + std::to_string(size.height);
        };
        if (lens.picture != photographed.size)
            return fail(options.lens + ": is of photographs of " + text(lens.picture) + ", and these have " +
                        text(photographed.size) + ": expected the same camera and zoom");
    }
    std::vector<Seen> seen;
    for (std::size_t i = 0; i < projectors.size(); ++i)
        seen.push_back({projectors[i].width, projectors[i].height, photographed.matches[i]});
    auto screen = find_curved_screen(options.lens.empty() ? nullptr : &lens, seen);
    if (!screen) return tl::unexpected(screen.error());
    for (std::size_t i = 0; i < projectors.size(); ++i) put(projectors[i], std::move(screen->seen[i]));
    return screen->error;
}

Result<void> run(const Options& options) {
    if (options.pictures.empty()) return fail("--pictures is missing: expected the photographs' folder");
    if (!options.lens.empty() && !options.curved)
        return fail("--lens goes with --screen curved: on a flat screen the lens is found with the rest");
    auto projectors = projectors_of(options);
    if (!projectors) return tl::unexpected(projectors.error());
    if (!options.camera.empty() || !options.capture.empty())
        if (auto taken = take(options, *projectors); !taken) return taken;
    const auto photographed = read_all(options, *projectors);
    if (!photographed) return tl::unexpected(photographed.error());
    const auto error = options.curved ? put_on_curved_screen(options, *photographed, *projectors)
                                      : put_on_flat_screen(*photographed, *projectors);
    if (!error) return tl::unexpected(error.error());
    const auto tiles = plan_wall(*projectors);
    if (!tiles) return tl::unexpected(tiles.error());
    if (auto written = write(options, *tiles); !written) return written;
    std::cout << "95 % of the matches are off by less than " << *error << " pixels of a projector\n"
              << (options.out / "tiles.toml").string() << " has what wall.toml wants to know\n";
    return {};
}

/// From photographs of a board, all that are in the folder.
Result<void> run_lens(const Options& options) {
    int width = 0, height = 0;
    char more = 0;
    if (std::sscanf(options.board.c_str(), "%dx%d%c", &width, &height, &more) != 2 || width < 3 || height < 3 ||
        width > kMostCorners || height > kMostCorners)
        return fail("--board: expected the inner corners of a chessboard, such as 9x6, at least 3x3");
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(options.pictures, error)) files.push_back(entry.path());
    if (error) return fail(options.pictures.string() + ": " + error.message());
    std::ranges::sort(files);
    std::vector<cv::Mat> photographs;
    for (const auto& file : files) {
        auto picture = read(file);
        if (!picture) return tl::unexpected(picture.error());
        photographs.push_back(std::move(*picture));
    }
    const auto lens = find_lens(photographs, {width, height});
    if (!lens) return tl::unexpected(lens.error());
    if (auto written = write_whole(options.lens, lens_text(*lens), kMode); !written) return written;
    std::cout << "the corners are off by " << lens->error << " pixels (root mean square)\n"
              << options.lens << " has the lens, for --screen curved --lens " << options.lens << '\n';
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "wallcalibrate: finds where projectors lie on a screen, with a camera that sees all of it and does not move,\n"
        "and writes the warps and blends that make one picture of theirs. On a curved screen the picture is right as\n"
        "seen from where the camera stands. The same as `wallctl calibrate`.");
    app.footer(
        "Examples:\n  wallctl calibrate --pictures shots --camera /dev/video0 --out /etc/wallgl\n"
        "  wallctl calibrate --pictures shots --capture 'gphoto2 --capture-image-and-download --filename {}'\n"
        "  wallctl calibrate --pictures shots          (photographs that were taken before)\n"
        "  wallctl calibrate lens --pictures boards --board 9x6 --out lens.yml      (photographs of a chessboard)\n"
        "  wallctl calibrate --pictures shots --screen curved --lens lens.yml");
    Options options;
    if (const char* walld = std::getenv("WALLGL_WALLD"); walld && *walld) options.walld.address = walld;
    if (const char* token = std::getenv("WALLGL_TOKEN_FILE"); token) options.walld.token_file = token;
    app.add_option("--walld", options.walld.address, "where walld is: unix:PATH or HOST:PORT (WALLGL_WALLD)")
        ->type_name("ADDR");
    app.add_option("--token-file", options.walld.token_file, "asks as the token in this file (WALLGL_TOKEN_FILE)")
        ->type_name("FILE");
    app.add_option("--pictures", options.pictures,
                   "the photographs' folder; they are called TILE-white.png, TILE-x-3.png");
    auto* camera = app.add_option("--camera", options.camera, "takes them first, with this camera (by ffmpeg)");
    app.add_option("--capture", options.capture, "takes them first, by this command; {} is the file's name")
        ->excludes(camera);
    app.add_option("--settle", options.settle, "seconds from a test picture to its photograph (0.5)")
        ->check(CLI::Range(0.0, 60.0));
    app.add_option("--tile", options.tiles, "only these tiles (all); may be given again");
    app.add_option("--gamma", options.gamma, "of the projectors (2.2)")->check(CLI::Range(0.1, 10.0));
    app.add_option("--out", options.out, "where the warps and tiles.toml are written (here)");
    app.add_option_function<std::string>(
           "--screen", [&options](const std::string& shape) { options.curved = shape == "curved"; },
           "flat, or curved: any smooth shape (flat)")
        ->check(CLI::IsMember({"flat", "curved"}));
    app.add_option("--lens", options.lens, "of the camera, for curved screens (bends nothing)")->type_name("FILE");
    auto* lens = app.add_subcommand("lens", "finds the camera's lens, from photographs of a chessboard");
    lens->add_option("--pictures", options.pictures, "their folder; at least five, all of the board")->required();
    lens->add_option("--board", options.board, "its inner corners, such as 9x6")->required();
    lens->add_option("--out", options.lens, "the file for --lens")->required()->type_name("FILE");
    app.set_version_flag("--version", WALLGL_VERSION);
    CLI11_PARSE(app, argc, argv);
    try {
        if (const auto done = lens->parsed() ? run_lens(options) : run(options); !done) {
            std::cerr << "wallcalibrate: " << done.error().message << '\n';
            return 1;
        }
    } catch (const std::exception& error) {
        std::cerr << "wallcalibrate: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
