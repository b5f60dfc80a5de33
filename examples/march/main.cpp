// SPDX-License-Identifier: MIT
// march: an example of a parallel program. Several processes compute a moving surface (marching tetrahedra), each some
// layers of it, and all draw into the same window; the depth test makes one picture of it. One process alone does as
// well, on any OpenGL. `march --help` tells how to start it; docs/parallel-programs.md explains the rest.
#include <GL/gl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "examples/march/tetrahedra.h"
#include "examples/picture.h"
#include "examples/team.h"
#include "examples/window.h"

namespace {

using namespace march;
using example::Rank;
using example::Team;

constexpr const char* kHelp = R"(march: soft balls by marching tetrahedra, drawn by one process or by several.

  march                                  one process, any OpenGL
  wallrun --parallel 4 -- march          four processes, one picture on the wall
  mpirun -n 4 wallrun --parallel-group march -- march     the same, started by MPI

  --size WxH      window, in pixels (800x600)
  --cells N       cells along each side of the cube (64)
  --balls N       (12)
  --seed N        of the balls' ways (1): the same seed gives the same pictures, however many processes draw them
  --frames N      ends after so many; 0: when the window is closed (0)
  --fps N         at most so many frames a second; 0: as many as can be (0)
  --picture FILE  writes the last frame as it is before the last swap (PPM)
  --rank I --ranks N   this process draws part I of N (from WALLGL_PARALLEL, else 0 of 1)
At the end it prints frames and triangles a second: of all processes, as seen by each.
)";

struct Options {
    int width = 800, height = 600, cells = 64, balls = 12, frames = 0, fps = 0;
    unsigned seed = 1;
    Rank rank = example::rank_from_environment();
    std::string picture;
};

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        const char* value = argv[i + 1];
        if (name == "--size" && std::sscanf(value, "%dx%d", &o.width, &o.height) == 2) continue;
        else if (name == "--cells") o.cells = std::atoi(value);
        else if (name == "--balls") o.balls = std::atoi(value);
        else if (name == "--seed") o.seed = static_cast<unsigned>(std::atoi(value));
        else if (name == "--frames") o.frames = std::atoi(value);
        else if (name == "--fps") o.fps = std::atoi(value);
        else if (name == "--rank") o.rank.own = std::atoi(value);
        else if (name == "--ranks") o.rank.all = std::atoi(value);
        else if (name == "--picture") o.picture = value;
        else return false;
    }
    return argc % 2 == 1 && o.width > 0 && o.height > 0 && o.cells > 0 && o.balls > 0 && o.frames >= 0 && o.fps >= 0 &&
           o.rank.own >= 0 && o.rank.own < o.rank.all;
}

/// State is each process's own: all set the same.
void set_up(const Options& o) {
    glViewport(0, 0, o.width, o.height);
    glMatrixMode(GL_PROJECTION);
    const double aspect = static_cast<double>(o.width) / o.height;
    glFrustum(-0.5 * aspect, 0.5 * aspect, -0.5, 0.5, 1.5, 6);
    glMatrixMode(GL_MODELVIEW);
    glTranslatef(0, 0, -3.2f);
    glRotatef(25, 1, 0.4f, 0);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);    // whoever draws first or last: what is nearest stays
    glEnable(GL_CULL_FACE);  // a back would lie beside its front at the same depth, along the outline
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    const float color[] = {0.9f, 0.5f, 0.2f, 1}, shine[] = {0.6f, 0.6f, 0.6f, 1};
    glMaterialfv(GL_FRONT, GL_AMBIENT_AND_DIFFUSE, color);
    glMaterialfv(GL_FRONT, GL_SPECULAR, shine);
    glMaterialf(GL_FRONT, GL_SHININESS, 30);
    glClearColor(0.05f, 0.07f, 0.12f, 1);
}

void draw(const std::vector<Corner>& corners) {
    glBegin(GL_TRIANGLES);
    for (const Corner& corner : corners) {
        glNormal3fv(&corner.normal.x);
        glVertex3fv(&corner.position.x);
    }
    glEnd();
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    if (argc == 2 && std::strcmp(argv[1], "--help") == 0) return std::fputs(kHelp, stdout), 0;
    if (!parse(argc, argv, o)) return std::fputs(kHelp, stderr), 2;
    example::Window window("march", o.width, o.height);
    const Team team("march", o.rank);
    set_up(o);
    Field field(o.seed, o.balls);
    Tetrahedra surface(o.cells);
    const int first = o.cells * o.rank.own / o.rank.all, last = o.cells * (o.rank.own + 1) / o.rank.all;

    const auto start = std::chrono::steady_clock::now();
    double triangles = 0;
    int frame = 0;
    auto due = start;  // the next frame, at the rate that is wanted
    while (window.is_open() && (o.frames == 0 || frame < o.frames)) {
        if (o.fps > 0) {
            std::this_thread::sleep_until(due);
            due = std::max(due, std::chrono::steady_clock::now()) +
                  std::chrono::nanoseconds(std::chrono::seconds(1)) / o.fps;
        }
        field.move_to(++frame);
        const auto& corners = surface.march(field, first, last);
        triangles += static_cast<double>(corners.size()) / 3;
        if (team.first()) glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        team.barrier();  // nobody draws into what is not cleared yet
        draw(corners);
        if (frame == o.frames && !o.picture.empty()) {
            team.barrier();  // all have drawn
            if (team.first()) example::write_picture(o.picture, o.width, o.height);
        }
        window.swap();  // a barrier, too: the frame ends when all have ended it
    }
    glFinish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("rank %d of %d: %d frames in %.3f s: %.2f frames/s, %.0f triangles/s\n", o.rank.own, o.rank.all, frame,
                seconds.count(), frame / seconds.count(), triangles / seconds.count());
}
