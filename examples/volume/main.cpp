// SPDX-License-Identifier: MIT
// volume: an example of a parallel program that blends. A volume is shown by planes through it, each laid over the ones
// behind it; several processes have a slab of it each, and lay theirs over one another, the farthest first, by turns.
// `wallrun --sort-last` draws them at the same time, on a node each, and lays their pictures over one another
// (docs/sort-last.md). One process alone does as well, on any OpenGL.
#include <GL/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "examples/picture.h"
#include "examples/team.h"
#include "examples/volume/brick.h"
#include "examples/window.h"

namespace {

using namespace volume;
using example::Rank;
using example::Team;

constexpr const char* kHelp = R"(volume: soft balls as a cloud, drawn by one process or by several.

  volume                                          one process, any OpenGL
  wallrun --parallel 4 -- volume                  four processes, one behind the other
  wallrun --parallel 4 --sort-last -- volume      the same, on a node each

  --size WxH      window, in pixels (800x600)
  --cells N       cells along each side of the cube (96)
  --planes N      through the cube (200)
  --balls N       (12)
  --seed N        of the balls' places (1)
  --frames N      ends after so many; 0: when the window is closed (0)
  --step N        degrees that the cube turns from frame to frame (2)
  --picture FILE  writes the last frame as it is before the last swap (PPM)
  --order WHICH   of the slabs: back (the farthest first), or front, which is wrong: to see what it matters (back)
  --rank I --ranks N   this process draws part I of N (from WALLGL_PARALLEL, else 0 of 1)
At the end it prints frames a second.
)";

constexpr float kDistance = 3.6f;  // of the cube's middle
constexpr float kTilt = 25, kDegree = 3.14159265f / 180;

struct Options {
    int width = 800, height = 600, cells = 96, planes = 200, balls = 12, frames = 0, step = 2;
    unsigned seed = 1;
    bool front_first = false;
    Rank rank = example::rank_from_environment();
    std::string picture;
};

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i], value = argv[i + 1];
        const int number = std::atoi(value.c_str());
        if (name == "--size" && std::sscanf(value.c_str(), "%dx%d", &o.width, &o.height) == 2) continue;
        else if (name == "--cells") o.cells = number;
        else if (name == "--planes") o.planes = number;
        else if (name == "--balls") o.balls = number;
        else if (name == "--seed") o.seed = static_cast<unsigned>(number);
        else if (name == "--frames") o.frames = number;
        else if (name == "--step") o.step = number;
        else if (name == "--picture") o.picture = value;
        else if (name == "--order" && (value == "front" || value == "back")) o.front_first = value == "front";
        else if (name == "--rank") o.rank.own = number;
        else if (name == "--ranks") o.rank.all = number;
        else return false;
    }
    return argc % 2 == 1 && o.width > 0 && o.height > 0 && o.cells > 0 && o.planes > 0 && o.balls > 0 &&
           o.frames >= 0 && o.rank.own >= 0 && o.rank.own < o.rank.all && o.rank.all <= o.cells;
}

/// State is each process's own: all set the same.
void set_up(const Options& o) {
    glViewport(0, 0, o.width, o.height);
    glMatrixMode(GL_PROJECTION);
    const double aspect = static_cast<double>(o.width) / o.height;
    glFrustum(-0.5 * aspect, 0.5 * aspect, -0.5, 0.5, 1.5, 8);
    glMatrixMode(GL_MODELVIEW);
    glEnable(GL_TEXTURE_3D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are multiplied by their opacity already
    glClearColor(0.05f, 0.07f, 0.12f, 1);
}

/// How the cube stands in a frame: about its own axis, then tilted towards the eye.
Turn turn_in(int frame, int step) {
    const float around = static_cast<float>(frame * step) * kDegree;
    const float c = std::cos(around), s = std::sin(around), tc = std::cos(kTilt * kDegree),
                ts = std::sin(kTilt * kDegree);
    return {Vec3{c, 0, s}, Vec3{ts * s, tc, -ts * c}, Vec3{-tc * s, ts, tc * c}};
}

void load(const Turn& turn) {
    const float matrix[] = {turn[0].x, turn[1].x, turn[2].x, 0, turn[0].y, turn[1].y, turn[2].y,  0,
                            turn[0].z, turn[1].z, turn[2].z, 0, 0,         0,         -kDistance, 1};
    glLoadMatrixf(matrix);
}

int first_cell(const Options& o, int rank) { return o.cells * rank / o.rank.all; }

/// Whose turn is when: the slab's place among them all, as the eye sees them.
int place_of(const Options& o, const Turn& turn) {
    std::vector<float> borders;
    for (int rank = 0; rank <= o.rank.all; ++rank)
        borders.push_back(-1 + 2 * static_cast<float>(first_cell(o, rank)) / static_cast<float>(o.cells));
    auto order = back_to_front(borders, turned_back(turn, {0, 0, kDistance}).x);
    if (o.front_first) std::ranges::reverse(order);
    return static_cast<int>(std::ranges::find(order, o.rank.own) - order.begin());
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    if (argc == 2 && std::strcmp(argv[1], "--help") == 0) return std::fputs(kHelp, stdout), 0;
    if (!parse(argc, argv, o)) return std::fputs(kHelp, stderr), 2;
    example::Window window("volume", o.width, o.height);
    const Team team("volume", o.rank);
    set_up(o);
    const Brick brick(example::Field(o.seed, o.balls), o.cells, first_cell(o, o.rank.own),
                      first_cell(o, o.rank.own + 1), o.planes);
    const auto start = std::chrono::steady_clock::now();
    int frame = 0;
    while (window.is_open() && (o.frames == 0 || frame < o.frames)) {
        const Turn turn = turn_in(++frame, o.step);
        load(turn);
        if (team.first()) glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        team.barrier();  // nobody draws into what is not cleared yet
        const int place = place_of(o, turn);
        team.begin_turn(place);
        brick.draw(turn);
        team.end_turn(place);
        if (frame == o.frames && !o.picture.empty()) {
            team.barrier();  // all have drawn
            if (team.first()) example::write_picture(o.picture, o.width, o.height);
        }
        window.swap();  // a barrier, too: the frame ends when all have ended it
    }
    glFinish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("rank %d of %d: %d frames in %.3f s: %.2f frames/s\n", o.rank.own, o.rank.all, frame, seconds.count(),
                frame / seconds.count());
}
