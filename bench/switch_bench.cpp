// SPDX-License-Identifier: MIT
// Switching one driver between contexts (Tracking Graphics State, section 5): the soft switch between identical
// contexts, between ones that differ in modelview matrix and current colour and draw a triangle each ("varying"), and
// between wholly different ones; beside it eglMakeCurrent between two contexts of the same driver, and the same drawing
// in one context. In every "varying" line the driver gets the same: another matrix, another colour, one small triangle.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include "bench/render_side.h"
#include "gen/glstate/samples.gen.h"
#include "tileserver/session/soft_switch.h"

namespace wall::tileserver {
namespace {

namespace el = glstate::el;
namespace pack = glapi::pack;
using namespace bench;

constexpr std::int64_t kTurns = 1000;  // switches between two glFinish
constexpr std::array<glstate::Vec4, 2> kColors = {{{1, 0.5f, 0, 1}, {0, 0.5f, 1, 1}}};
constexpr std::array<glstate::Mat4, 2> kMatrices = {{{0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1, 0, -0.3f, 0, 0, 1},
                                                     {0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1, 0, 0.3f, 0, 0, 1}}};

/// Two contexts of the same driver, each with a window of its own.
class EglPair {
public:
    EglPair() {
        keep_freed_memory();
        const auto get_display =
            reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
        display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        WALL_ASSERT(eglInitialize(display_, nullptr, nullptr) == EGL_TRUE && eglBindAPI(EGL_OPENGL_API) == EGL_TRUE);
        const EGLint wanted[] = {EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT,
                                 EGL_RENDERABLE_TYPE,
                                 EGL_OPENGL_BIT,
                                 EGL_RED_SIZE,
                                 8,
                                 EGL_GREEN_SIZE,
                                 8,
                                 EGL_BLUE_SIZE,
                                 8,
                                 EGL_DEPTH_SIZE,
                                 24,
                                 EGL_STENCIL_SIZE,
                                 8,
                                 EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        WALL_ASSERT(eglChooseConfig(display_, wanted, &config, 1, &count) == EGL_TRUE && count == 1);
        const EGLint size[] = {EGL_WIDTH, kSize, EGL_HEIGHT, kSize, EGL_NONE};
        const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                                  4,
                                  EGL_CONTEXT_MINOR_VERSION,
                                  5,
                                  EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                  EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
                                  EGL_NONE};
        for (std::size_t i = 0; i < 2; ++i) {
            surfaces_[i] = eglCreatePbufferSurface(display_, config, size);
            contexts_[i] = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
        }
        make_current(0, 0);
        gl_.load([](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); });
    }
    ~EglPair() {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        for (const EGLContext context : contexts_) eglDestroyContext(display_, context);
        for (const EGLSurface surface : surfaces_) eglDestroySurface(display_, surface);
    }
    EglPair(const EglPair&) = delete;
    void make_current(std::size_t context, std::size_t window) {
        WALL_ASSERT(eglMakeCurrent(display_, surfaces_[window], surfaces_[window], contexts_[context]) == EGL_TRUE);
    }
    const Gl& gl() const { return gl_; }

private:
    EGLDisplay display_;
    std::array<EGLSurface, 2> surfaces_{};
    std::array<EGLContext, 2> contexts_{};
    Gl gl_;
};

// ---- what is drawn ----

void set_values(const Gl& gl, std::size_t who) {
    gl.MatrixMode(GL_MODELVIEW);
    gl.LoadMatrixf(kMatrices[who].data());
    gl.Color4f(kColors[who][0], kColors[who][1], kColors[who][2], kColors[who][3]);
}

void draw_triangle(const Gl& gl) {
    gl.Begin(GL_TRIANGLES);
    gl.Vertex3f(-0.1f, -0.1f, 0);
    gl.Vertex3f(0.1f, -0.1f, 0);
    gl.Vertex3f(0, 0.1f, 0);
    gl.End();
}

void set_varying(glstate::State& state, std::size_t who) {
    glstate::assign<el::modelview>(state, 0, kMatrices[who]);
    glstate::assign<el::color>(state, 0, kColors[who]);
}

/// Every element of the categories that a switch tells at its n-th sample; but for pixel transfer, which makes Mesa
/// fill a texture anew with each triangle.
void set_samples(glstate::State& state, std::size_t n) {
    glstate::for_each_element([&]<class E>() {
        constexpr auto kKept =
            glstate::kLayerCategories | ~glstate::kSentCategories | glstate::mask_of(glstate::Category::textures) |
            glstate::mask_of(glstate::Category::objects) | glstate::mask_of(glstate::Category::modelview_origin) |
            glstate::mask_of(glstate::Category::pixel_transfer);
        if ((kKept & glstate::mask_of(E::category)) != 0) return;
        for (unsigned i = 0; i < E::count; ++i) glstate::assign<E>(state, i, glstate::Samples<E>::values[(n + i) % 3]);
    });
    for (unsigned i = 0; i < 32; ++i)  // not every coordinate has every mode
        if (i % 4 > 1) state.texture_gen.tex_gen_mode[i] = n == 0 ? GL_OBJECT_LINEAR : GL_EYE_LINEAR;
}

/// Times `turn(i)`, i = 0, 1, 0, 1..., with a glFinish after every kTurns.
template <class Turn>
void time_turns(benchmark::State& run, const Gl& gl, Turn&& turn) {
    for (auto _ : run) {
        for (std::int64_t i = 0; i < kTurns; ++i) turn(static_cast<std::size_t>(i & 1));
        gl.Finish();
    }
    run.SetItemsProcessed(static_cast<std::int64_t>(run.iterations()) * kTurns);
}

// ---- identical ----

/// Both contexts are fresh, or have equal values that were set in each of them apart.
template <bool kFresh>
void Identical_Soft(benchmark::State& run) {
    Node node(To::null);
    Client client(node, SessionId(1));
    std::array<SoftContext*, 2> contexts = {&client.context(ContextId(1)), &client.context(ContextId(2))};
    if (!kFresh)
        for (SoftContext* context : contexts) set_samples(context->state, 1);
    Layer& layer = client.layer();
    time_turns(run, node.gl(), [&](std::size_t i) {
        benchmark::DoNotOptimize(switch_to(node.node(), client.session, *contexts[i], layer, {true, true}));
    });
}
BENCHMARK(Identical_Soft<true>)->Name("identical/soft switch/fresh")->UseRealTime();
BENCHMARK(Identical_Soft<false>)->Name("identical/soft switch/equal values")->UseRealTime();

void Identical_Egl(benchmark::State& run) {
    EglPair egl;
    time_turns(run, egl.gl(), [&](std::size_t i) { egl.make_current(i, 0); });
}
BENCHMARK(Identical_Egl)->Name("identical/eglMakeCurrent")->UseRealTime();

// ---- varying ----

void Varying_Soft(benchmark::State& run, To to) {
    Node node(to);
    Client client(node, SessionId(1));
    std::array<SoftContext*, 2> contexts = {&client.context(ContextId(1)), &client.context(ContextId(2))};
    for (std::size_t i = 0; i < 2; ++i) set_varying(contexts[i]->state, i);
    Layer& layer = client.layer();
    time_turns(run, node.gl(), [&](std::size_t i) {
        benchmark::DoNotOptimize(switch_to(node.node(), client.session, *contexts[i], layer, {true, true}));
        draw_triangle(node.gl());
    });
}
BENCHMARK_CAPTURE(Varying_Soft, null, To::null)->Name("varying/null driver/soft switch")->UseRealTime();
BENCHMARK_CAPTURE(Varying_Soft, llvmpipe, To::llvmpipe)->Name("varying/llvmpipe/soft switch")->UseRealTime();

/// The same drawing in one context: its commands without any switch.
void Varying_One(benchmark::State& run, To to) {
    Node node(to);
    Client client(node, SessionId(1));
    benchmark::DoNotOptimize(
        switch_to(node.node(), client.session, client.context(ContextId(1)), client.layer(), {true, true}));
    time_turns(run, node.gl(), [&](std::size_t i) {
        set_values(node.gl(), i);
        draw_triangle(node.gl());
    });
}
BENCHMARK_CAPTURE(Varying_One, null, To::null)->Name("varying/null driver/one context")->UseRealTime();
BENCHMARK_CAPTURE(Varying_One, llvmpipe, To::llvmpipe)->Name("varying/llvmpipe/one context")->UseRealTime();

/// Both on one driver in turn, kTurns each: the counter `kept` is the median of what the soft switch reaches of the
/// rate without one. A driver's speed changes from process to process and from second to second by more than the
/// difference.
void Varying_Kept(benchmark::State& run) {
    Node node(To::llvmpipe);
    Client client(node, SessionId(1));
    std::array<SoftContext*, 2> contexts = {&client.context(ContextId(1)), &client.context(ContextId(2))};
    for (std::size_t i = 0; i < 2; ++i) set_varying(contexts[i]->state, i);
    Layer& layer = client.layer();
    const auto seconds = [&](auto&& turn) {
        const auto start = std::chrono::steady_clock::now();
        for (std::int64_t i = 0; i < kTurns; ++i)
            turn(static_cast<std::size_t>(i & 1));  // ends with the second's values, as the driver's mirror has them
        node.gl().Finish();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const auto soft = [&](std::size_t i) {
        benchmark::DoNotOptimize(switch_to(node.node(), client.session, *contexts[i], layer, {true, true}));
        draw_triangle(node.gl());
    };
    const auto one = [&](std::size_t i) {
        set_values(node.gl(), i);
        draw_triangle(node.gl());
    };
    std::vector<double> kept;
    seconds(soft), seconds(one);
    for (auto _ : run) {
        const double first = seconds(one), switched = seconds(soft), second = seconds(one);
        kept.push_back((first + second) / 2 / switched);
    }
    std::ranges::nth_element(kept, kept.begin() + static_cast<std::ptrdiff_t>(kept.size() / 2));
    run.counters["kept"] = kept[kept.size() / 2];
}
static_assert(kTurns % 2 == 0);
BENCHMARK(Varying_Kept)->Name("varying/llvmpipe/soft switch and one context in turn")->UseRealTime()->Iterations(101);

void Varying_Egl(benchmark::State& run) {
    EglPair egl;
    for (const std::size_t i : {1, 0}) {
        egl.make_current(i, 0);
        set_values(egl.gl(), i);
    }
    time_turns(run, egl.gl(), [&](std::size_t i) {
        egl.make_current(i, 0);
        draw_triangle(egl.gl());
    });
}
BENCHMARK(Varying_Egl)->Name("varying/llvmpipe/eglMakeCurrent")->UseRealTime();

/// The whole way of a batch: two sessions with a window each, their packed commands decoded and executed in turn.
void Varying_Batches(benchmark::State& run, To to) {
    Node node(to);
    std::array<std::unique_ptr<Client>, 2> clients;
    std::array<std::vector<std::byte>, 2> payloads;
    for (std::size_t i = 0; i < 2; ++i) {
        clients[i] = std::make_unique<Client>(node, SessionId(static_cast<std::uint32_t>(i + 1)));
        set_varying(clients[i]->context(ContextId(1)).state, i);
        wire::PackBuffer body, buffer;
        pack::Begin(body, GL_TRIANGLES);
        pack::Vertex3f(body, -0.1f, -0.1f, 0);
        pack::Vertex3f(body, 0.1f, -0.1f, 0);
        pack::Vertex3f(body, 0, 0.1f, 0);
        pack::End(body);
        pack::Block(buffer, 1, 0, static_cast<std::uint32_t>(body.commands()),
                    static_cast<std::uint32_t>(body.operand_bytes()));
        buffer.append(body, {}, body.mark());
        wire::append_batch(payloads[i], {ContextId(1), buffer.opcodes(), buffer.operands()});
    }
    time_turns(run, node.gl(),
               [&](std::size_t i) { benchmark::DoNotOptimize(clients[i]->executor.run_batch(payloads[i])); });
}
BENCHMARK_CAPTURE(Varying_Batches, null, To::null)
    ->Name("two windows/null driver/batches of two sessions")
    ->UseRealTime();
BENCHMARK_CAPTURE(Varying_Batches, llvmpipe, To::llvmpipe)
    ->Name("two windows/llvmpipe/batches of two sessions")
    ->UseRealTime();

void TwoWindows_Egl(benchmark::State& run) {
    EglPair egl;
    for (const std::size_t i : {1, 0}) {
        egl.make_current(i, i);
        set_values(egl.gl(), i);
    }
    time_turns(run, egl.gl(), [&](std::size_t i) {
        egl.make_current(i, i);
        draw_triangle(egl.gl());
    });
}
BENCHMARK(TwoWindows_Egl)->Name("two windows/llvmpipe/eglMakeCurrent")->UseRealTime();

// ---- wholly different ----

void Different_Soft(benchmark::State& run, To to) {
    Node node(to);
    Client client(node, SessionId(1));
    std::array<SoftContext*, 2> contexts = {&client.context(ContextId(1)), &client.context(ContextId(2))};
    for (std::size_t i = 0; i < 2; ++i) set_samples(contexts[i]->state, i);
    Layer& layer = client.layer();
    time_turns(run, node.gl(), [&](std::size_t i) {
        benchmark::DoNotOptimize(switch_to(node.node(), client.session, *contexts[i], layer, {true, true}));
        draw_triangle(node.gl());
    });
}
BENCHMARK_CAPTURE(Different_Soft, null, To::null)->Name("different/null driver/soft switch")->UseRealTime();
BENCHMARK_CAPTURE(Different_Soft, llvmpipe, To::llvmpipe)->Name("different/llvmpipe/soft switch")->UseRealTime();

void Different_Egl(benchmark::State& run) {
    EglPair egl;
    for (const std::size_t i : {1, 0}) {
        egl.make_current(i, 0);
        glstate::State state;
        set_samples(state, i);
        Driver driver(egl.gl());
        driver.sync(state);
        driver.sync_current(state);
    }
    time_turns(run, egl.gl(), [&](std::size_t i) {
        egl.make_current(i, 0);
        draw_triangle(egl.gl());
    });
}
BENCHMARK(Different_Egl)->Name("different/llvmpipe/eglMakeCurrent")->UseRealTime();

}  // namespace
}  // namespace wall::tileserver
