// SPDX-License-Identifier: MIT
// panorama: an example of a program that knows of tiles which look elsewhere (GL_WALLGL_views, docs/walls.md). It walks
// through a town and draws only the houses that somebody sees, as games and viewers do. Unmodified, such a program
// leaves out what is beside its own camera, and tiles that look there stay empty; asking the wall for its views is all
// that it takes. It runs on any OpenGL. `panorama --help` tells the options.
#include <GL/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "examples/window.h"

namespace {

constexpr const char* kHelp = R"(panorama: a walk through a town, of which only what is seen is drawn.

  panorama                       in a window, on any OpenGL
  wallrun --fullscreen panorama  on all tiles of a wall, also of one whose tiles stand around the people

  --size WxH     window, in pixels (800x600)
  --houses N     along each side of the town (60)
  --frames N     ends after so many; 0: when the window is closed (0)
  --fps N        at most so many frames a second; 0: as many as can be (60)
  --still        stands still and looks ahead: all frames are the same
  --alone        asks nobody: draws what its own camera sees, as programs do that know nothing of walls
At the end it prints frames a second, the views that it was told, and the houses drawn a frame.
)";

struct Options {
    int width = 800, height = 600, houses = 60, frames = 0, fps = 60;
    bool still = false, alone = false;
};

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i];
        const char* value = i + 1 < argc ? argv[i + 1] : "";
        if (name == "--still") o.still = true;
        else if (name == "--alone") o.alone = true;
        else if (name == "--size" && std::sscanf(value, "%dx%d", &o.width, &o.height) == 2) ++i;
        else if (name == "--houses" && std::sscanf(value, "%d", &o.houses) == 1) ++i;
        else if (name == "--frames" && std::sscanf(value, "%d", &o.frames) == 1) ++i;
        else if (name == "--fps" && std::sscanf(value, "%d", &o.fps) == 1) ++i;
        else return false;
    }
    return o.width > 0 && o.height > 0 && o.houses > 0 && o.frames >= 0 && o.fps >= 0;
}

/// To the right, up and ahead of the camera.
using Direction = std::array<float, 3>;

float dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// What a screen shows: its own axes, and its edges at distance 1, as glGetViewsWALLGL gives them.
struct View {
    Direction right{1, 0, 0}, up{0, 1, 0}, ahead{0, 0, 1};
    float left, right_edge, bottom, top;

    /// Whether a ball there may be seen: it is not wholly behind one of the planes through the eye and an edge.
    bool sees(const Direction& middle, float radius) const {
        const float x = dot(middle, right), y = dot(middle, up), z = dot(middle, ahead);
        const auto inside = [&](float along, float edge) {  // of the plane that `along` crosses where along = edge * z
            return along - edge * z > -radius * std::sqrt(1 + edge * edge);
        };
        return inside(x, left) && inside(-x, -right_edge) && inside(y, bottom) && inside(-y, -top);
    }
};
static_assert(sizeof(View) == 13 * sizeof(float));

/// The views of the tiles that show the window; none where the wall has none, or there is no wall.
class WallViews {
public:
    WallViews() {
        const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
        if (extensions && std::strstr(extensions, "GL_WALLGL_views"))
            get_ = reinterpret_cast<Get>(glXGetProcAddress(reinterpret_cast<const GLubyte*>("glGetViewsWALLGL")));
    }
    /// Asked in each frame: they change while the program runs.
    std::vector<View> now() const {
        std::vector<View> views(get_ ? static_cast<std::size_t>(get_(0, nullptr)) : 0);
        if (!views.empty()) get_(static_cast<GLsizei>(views.size()), &views.front().right[0]);
        return views;
    }

private:
    using Get = GLsizei (*)(GLsizei count, GLfloat* views);
    Get get_ = nullptr;
};

struct House {
    float x, z, height;  ///< on the ground; its sides are 1
    std::array<float, 3> color;
};

std::vector<House> town(int side) {
    std::vector<House> houses;
    const auto part = [](int a, int b, int c) {  // a fixed number from 0 to 1 for each
        const double wild = std::sin(a * 12.9898 + b * 78.233 + c * 37.719) * 43758.5453;
        return static_cast<float>(wild - std::floor(wild));
    };
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const float x = 2.5f * static_cast<float>(column - side / 2) + 1.25f,
                        z = 2.5f * static_cast<float>(row - side / 2) + 1.25f;
            houses.push_back({x,
                              z,
                              0.6f + 3 * part(row, column, 0),
                              {0.4f + 0.5f * part(row, column, 1), 0.4f + 0.4f * part(row, column, 2), 0.5f}});
        }
    return houses;
}

void draw_house(const House& house) {
    constexpr float kHalf = 0.5f;
    glColor3fv(house.color.data());
    glBegin(GL_QUADS);
    constexpr std::array<std::array<float, 2>, 5> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& [ax, az] = kCorners[i];
        const auto& [bx, bz] = kCorners[i + 1];
        glNormal3f((ax + bx) / 2, 0, (az + bz) / 2);
        glVertex3f(house.x + kHalf * ax, 0, house.z + kHalf * az);
        glVertex3f(house.x + kHalf * ax, house.height, house.z + kHalf * az);
        glVertex3f(house.x + kHalf * bx, house.height, house.z + kHalf * bz);
        glVertex3f(house.x + kHalf * bx, 0, house.z + kHalf * bz);
    }
    glNormal3f(0, 1, 0);
    for (std::size_t i = 0; i < 4; ++i)
        glVertex3f(house.x + kHalf * kCorners[i][0], house.height, house.z - kHalf * kCorners[i][1]);
    glEnd();
}

struct Camera {
    float x = 0, z = 0, heading = 0;  ///< radians to the right of -z
    /// A place in the town, as it lies before the camera, whose eye is 1.2 above the ground.
    Direction seen(float at_x, float at_y, float at_z) const {
        const float dx = at_x - x, dz = at_z - z;
        return {dx * std::cos(heading) + dz * std::sin(heading), at_y - 1.2f,
                dx * std::sin(heading) - dz * std::cos(heading)};
    }
};

void set_up() {
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_COLOR_MATERIAL);
    glEnable(GL_FOG);
    const float sky[] = {0.55f, 0.7f, 0.9f, 1};
    glFogfv(GL_FOG_COLOR, sky);
    glFogi(GL_FOG_MODE, GL_LINEAR);
    glFogf(GL_FOG_START, 20);
    glFogf(GL_FOG_END, 70);
    glClearColor(sky[0], sky[1], sky[2], 1);
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    if (argc == 2 && std::strcmp(argv[1], "--help") == 0) return std::fputs(kHelp, stdout), 0;
    if (!parse(argc, argv, o)) return std::fputs(kHelp, stderr), 2;
    example::Window window("panorama", o.width, o.height);
    set_up();
    const WallViews wall;
    const std::vector<House> houses = town(o.houses);
    View own;
    own.right_edge = 0.8f;
    own.top = own.right_edge * static_cast<float>(o.height) / static_cast<float>(o.width);
    own.left = -own.right_edge;
    own.bottom = -own.top;

    const auto start = std::chrono::steady_clock::now();
    auto due = start;
    std::size_t told = 0, drawn = 0;
    int frame = 0;
    for (; window.is_open() && (o.frames == 0 || frame < o.frames); ++frame) {
        if (o.fps > 0) {
            std::this_thread::sleep_until(due);
            due += std::chrono::nanoseconds(std::chrono::seconds(1)) / o.fps;
        }
        const float time = o.still ? 0 : 0.01f * static_cast<float>(frame);
        const Camera camera{5 * std::sin(time), 5 * std::sin(2 * time), 0.5f * std::sin(0.7f * time)};
        std::vector<View> views = o.alone ? std::vector<View>() : wall.now();
        told = views.size();
        views.push_back(own);

        glViewport(0, 0, o.width, o.height);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        constexpr float kNear = 0.1f;
        glMatrixMode(GL_PROJECTION);
        glLoadIdentity();
        glFrustum(kNear * own.left, kNear * own.right_edge, kNear * own.bottom, kNear * own.top, kNear, 80);
        glMatrixMode(GL_MODELVIEW);
        glLoadIdentity();
        glRotatef(camera.heading * 180 / std::numbers::pi_v<float>, 0, 1, 0);
        glTranslatef(-camera.x, -1.2f, -camera.z);
        const float sun[] = {0.4f, 1, 0.6f, 0};
        glLightfv(GL_LIGHT0, GL_POSITION, sun);
        for (const House& house : houses) {
            const float radius = std::sqrt(0.5f + house.height * house.height / 4);
            const Direction middle = camera.seen(house.x, house.height / 2, house.z);
            const auto seen_by = [&](const View& view) { return view.sees(middle, radius); };
            bool seen = false;
            for (const View& view : views) seen = seen || seen_by(view);
            if (!seen) continue;
            draw_house(house);
            ++drawn;
        }
        window.swap();
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%d frames in %.2f s: %.1f frames/s; %zu views; %.1f of %zu houses drawn\n", frame, seconds.count(),
                frame / seconds.count(), told, static_cast<double>(drawn) / std::max(frame, 1), houses.size());
}
