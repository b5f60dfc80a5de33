// SPDX-License-Identifier: MIT
// A parallel program whose picture is right only if its processes draw in the order that semaphores and barriers say:
// no depth test, each frame a pile of squares, one of each rank in turn, whose last one lies on top. The colour of a
// pixel tells the frame and who drew it last.
//
// turns [--size WxH] [--frames N] [--fps N] [--order semaphores|barriers|none] [--misuse NAME] [--leave-at N]
//   green: rank and layer of the last square; red, blue: the frame's number, from frame N on the last one stays
//   --misuse: counts (different ones), deadlock, lonely-rank (only rank 0 makes the barrier): what a wrong program does
//   --leave-at: ranks above 0 end in order after so many frames
#include <GL/gl.h>
#include <GL/glx.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "tests/golden/programs/window.h"

namespace {

constexpr int kLayers = 3;

struct Options {
    golden::Size size{400, 300};
    int frames = 0, fps = 0, leave_at = 0;
    std::string order = "semaphores", misuse;
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        if (name == "--size") std::sscanf(argv[i + 1], "%dx%d", &options.size.width, &options.size.height);
        if (name == "--frames") options.frames = std::atoi(argv[i + 1]);
        if (name == "--fps") options.fps = std::atoi(argv[i + 1]);
        if (name == "--order") options.order = argv[i + 1];
        if (name == "--misuse") options.misuse = argv[i + 1];
        if (name == "--leave-at") options.leave_at = std::atoi(argv[i + 1]);
    }
    return options;
}

template <class... Arguments>
void call(const char* name, Arguments... arguments) {
    reinterpret_cast<void (*)(Arguments...)>(glXGetProcAddress(reinterpret_cast<const GLubyte*>(name)))(arguments...);
}

/// Semaphore 1 + rank: it is that rank's turn.
class Order {
public:
    Order(const std::string& kind, GLuint rank, GLuint ranks)
        : semaphores_(kind == "semaphores"), barriers_(kind == "barriers"), rank_(rank), ranks_(ranks) {
        call("glBarrierCreateCR", GLuint{1}, ranks);
        for (GLuint r = 0; r < ranks && semaphores_; ++r) call("glSemaphoreCreateCR", 1 + r, GLuint{r == 0});
    }
    void all() const { call("glBarrierExecCR", GLuint{1}); }
    template <class Draw>
    void in_turn(Draw&& draw) const {
        if (semaphores_) call("glSemaphorePCR", 1 + rank_);
        for (GLuint r = 0; r < ranks_; ++r) {
            if (r == rank_) draw();
            if (barriers_) all();
        }
        if (semaphores_) call("glSemaphoreVCR", 1 + (rank_ + 1) % ranks_);
    }

private:
    bool semaphores_, barriers_;
    GLuint rank_, ranks_;
};

void square(unsigned frame, GLuint rank, int layer) {
    glColor3ub(static_cast<GLubyte>(frame), static_cast<GLubyte>(16 * layer + static_cast<int>(rank) + 1),
               static_cast<GLubyte>(128 + (frame >> 8) % 128));
    const float inner = 1 - 0.25f * static_cast<float>(layer);
    glRectf(-inner, -inner, inner, inner);
}

void misuse(const std::string& kind, GLuint rank) {
    if (kind == "counts") call("glBarrierCreateCR", GLuint{9}, GLuint{1 + rank});
    if (kind == "deadlock") {
        call("glSemaphoreCreateCR", GLuint{9}, GLuint{0});
        call("glSemaphorePCR", GLuint{9});
    }
    if (kind == "lonely-rank" && rank == 0) call("glBarrierCreateCR", GLuint{9}, GLuint{1});
    if (kind == "lonely-rank") call("glBarrierExecCR", GLuint{9});
}

}  // namespace

int main(int argc, char** argv) {
    const Options options = parse(argc, argv);
    unsigned rank = 0, ranks = 1;
    if (const char* text = std::getenv("WALLGL_PARALLEL")) std::sscanf(text, "%*[^:]:%u:%u", &rank, &ranks);
    const auto window = golden::Window::by_glx(options.size, {});
    const Order order(options.order, rank, ranks);
    misuse(options.misuse, rank);
    std::printf("rank %u error 0x%x\n", rank, glGetError());
    std::fflush(stdout);
    const auto start = std::chrono::steady_clock::now();
    for (unsigned frame = 1;; ++frame) {
        if (options.frames != 0 && frame > static_cast<unsigned>(options.frames))
            std::this_thread::sleep_for(std::chrono::hours(1));
        if (options.leave_at != 0 && rank > 0 && frame > static_cast<unsigned>(options.leave_at)) return 0;
        if (options.fps != 0)
            std::this_thread::sleep_until(start + std::chrono::milliseconds(1000) * frame / options.fps);
        if (rank == 0) glClear(GL_COLOR_BUFFER_BIT);
        order.all();
        for (int layer = 0; layer < kLayers; ++layer) order.in_turn([&] { square(frame, rank, layer); });
        window->swap();
    }
}
