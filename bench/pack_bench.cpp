// SPDX-License-Identifier: MIT
// How fast immediate mode goes through the real libGL entry points into whatever vendor is selected: WallGL (on a
// wall), the bare packer (bench/bare_vendor) or Mesa. What is drawn lies beside the window, so that on a wall every
// vertex is packed, boxed and sorted but none is sent. bench/pack.py runs the vendors in turn.
#include <GL/gl.h>
#include <GL/glx.h>
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstring>

namespace {

constexpr int kVertices = 3000;  // of one glBegin

template <class Body>
void run(benchmark::State& state, Body&& body) {
    for (auto _ : state) {
        glBegin(GL_TRIANGLES);
        for (int i = 0; i < kVertices; ++i) body(static_cast<float>(i & 1023));
        glEnd();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kVertices);
}

void Vertex3f(benchmark::State& state) {
    run(state, [](float at) { glVertex3f(at, 2, 3); });
}
void Vertex3fv(benchmark::State& state) {
    run(state, [](float at) {
        const GLfloat v[] = {at, 2, 3};
        glVertex3fv(v);
    });
}
void Normal3fVertex3f(benchmark::State& state) {
    run(state, [](float at) { glNormal3f(0, 0, 1), glVertex3f(at, 2, 3); });
}
void Color3fVertex3f(benchmark::State& state) {
    run(state, [](float at) { glColor3f(1, 0.5f, 0), glVertex3f(at, 2, 3); });
}
void Color4ubTexCoord2fVertex3f(benchmark::State& state) {
    run(state, [](float at) { glColor4ub(1, 2, 3, 4), glTexCoord2f(0.5f, 0.25f), glVertex3f(at, 2, 3); });
}
BENCHMARK(Vertex3f);
BENCHMARK(Vertex3fv);
BENCHMARK(Normal3fVertex3f);
BENCHMARK(Color3fVertex3f);
BENCHMARK(Color4ubTexCoord2fVertex3f);

bool make_current(Display* display) {
    int attributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, None};
    XVisualInfo* visual = glXChooseVisual(display, DefaultScreen(display), attributes);
    if (!visual) return false;
    XSetWindowAttributes window_attributes{};
    const Window root = RootWindow(display, visual->screen);
    window_attributes.colormap = XCreateColormap(display, root, visual->visual, AllocNone);
    const Window window = XCreateWindow(display, root, 0, 0, 256, 256, 0, visual->depth, InputOutput, visual->visual,
                                        CWColormap | CWBorderPixel, &window_attributes);
    XMapWindow(display, window);
    GLXContext context = glXCreateContext(display, visual, nullptr, True);
    return glXMakeCurrent(display, window, context);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    Display* display = XOpenDisplay(nullptr);
    if (!display) return std::fputs("pack_bench: cannot open the display\n", stderr), 1;
    if (!make_current(display)) return std::fputs("pack_bench: no current context\n", stderr), 1;
    benchmark::AddCustomContext("vendor", reinterpret_cast<const char*>(glGetString(GL_VENDOR)));
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glTranslatef(100, 100, 0);  // x, y >= 100: beside the window
    glMatrixMode(GL_MODELVIEW);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
