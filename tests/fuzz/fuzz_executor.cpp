// SPDX-License-Identifier: MIT
// Batches executed on a real driver, in a session with a window on two tiles and in both members of a parallel program.
// After each input another session must still draw what it always draws. WALLGL_FUZZ_BACKEND: osmesa, else EGL.
#include <cstdlib>
#include <memory>
#include <numeric>

#include "common/base/assert.h"
#include "tests/fuzz/batch_input.h"
#include "tileserver/execute/executor.h"
#include "tileserver/gpu/backend.h"

namespace {

using namespace wall;
using namespace wall::tileserver;

constexpr int kOthersTurns = 4;
constexpr std::uint64_t kObjectBytes = std::uint64_t{4} << 20;  // of a session: gigabytes take the driver seconds

constexpr std::int64_t kPixels = 1 << 22;  // of its windows

constexpr std::int64_t kElements = 1 << 20;  // of a draw: more take the driver seconds, which a node puts up with

/// The driver's draws whose elements no buffer bounds, but for those of too many.
struct BoundedDraws {
    static inline glapi::GlFunctions of_driver;

    static bool few(std::int64_t elements, GLsizei instances = 1) { return elements * instances <= kElements; }
    static void arrays(GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws) {
        if (few(std::accumulate(count, count + draws, std::int64_t{0})))
            of_driver.MultiDrawArrays(mode, first, count, draws);
    }
    static void instances(GLenum mode, GLint first, GLsizei count, GLsizei instances) {
        if (few(count, instances)) of_driver.DrawArraysInstanced(mode, first, count, instances);
    }
    static void elements(GLenum mode, GLsizei count, GLenum type, const void* indices, GLsizei instances, GLint base) {
        if (few(count, instances))
            of_driver.DrawElementsInstancedBaseVertex(mode, count, type, indices, instances, base);
    }
    static void put_into(glapi::GlFunctions& gl) {
        of_driver = gl;
        gl.MultiDrawArrays = arrays;
        gl.DrawArraysInstanced = instances;
        gl.DrawElementsInstancedBaseVertex = elements;
    }
};

struct Ignore final : SessionOutput {
    void reply(RequestId, std::vector<std::byte> bytes) override { answer = std::move(bytes); }
    void frame_rendered(SurfaceId, std::uint32_t) override {}
    void partial(NodeIndex, std::vector<std::byte>) override {}
    std::vector<std::byte> answer;
};

struct Node {
    std::unique_ptr<GlBackend> backend;
    std::unique_ptr<Driver> driver;
    std::unique_ptr<RenderNode> node;

    Node() {
        const char* name = std::getenv("WALLGL_FUZZ_BACKEND");
        auto opened = open_backend({name != nullptr ? name : "egl"});
        WALL_ASSERT(opened && (*opened)->make_current());
        backend = std::move(*opened);
        Gl gl;
        gl.load([this](const char* name) { return backend->get_proc_address(name); });
        BoundedDraws::put_into(gl);
        driver = std::make_unique<Driver>(gl);
        node = std::make_unique<RenderNode>(*driver);
        node->tiles = {{0, {0, 0, 32, 32}}, {1, {32, 0, 32, 32}}};
    }
};

void run(Executor& executor, const wire::PackBuffer& buffer) {
    std::vector<std::byte> payload;
    wire::append_batch(payload, {ContextId(1), buffer.opcodes(), buffer.operands()});
    const auto done = executor.run_batch(payload);
    WALL_ASSERT(done);
}

void open_surface(Executor& executor) {
    wire::PackBuffer buffer;
    glapi::pack::SurfaceCreate(buffer, SurfaceId(1), 1, 8, 24, 8, 16, 0, 1, 0);
    glapi::pack::SurfacePlace(buffer, SurfaceId(1), 1, 64, 32, 0, 0, 64, 32, 0);
    glapi::pack::Bind(buffer, SurfaceId(1), SurfaceId(1));
    const glstate::Viewport viewport{0, 0, 64, 32};
    glapi::pack_state(buffer, glstate::el::viewport::id, &viewport, sizeof viewport);
    run(executor, buffer);
}

/// The one pixel in the middle of a green quad, drawn by a session of its own.
void check_others(RenderNode& node) {
    Ignore output;
    SessionReplica session(node.driver, SessionId(2));
    Executor executor(node, session, output);
    open_surface(executor);
    wire::PackBuffer body, buffer;
    glapi::pack::Clear(body, GL_COLOR_BUFFER_BIT);
    glapi::pack::Color4ub(body, 0xff00ff00);
    glapi::pack::Begin(body, GL_QUADS);
    for (const auto& [x, y] :
         {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
        glapi::pack::Vertex2f(body, x, y);
    glapi::pack::End(body);
    glapi::pack::Block(buffer, 1, 0, static_cast<std::uint32_t>(body.commands()),
                       static_cast<std::uint32_t>(body.operand_bytes()));
    buffer.append(body, {}, body.mark());
    glapi::pack::ReadPixels(buffer, RequestId(1), 0, 16, 16, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    run(executor, buffer);
    const std::array<std::byte, 4> green = {std::byte{0}, std::byte{255}, std::byte{0}, std::byte{255}};
    WALL_ASSERT(std::equal(green.begin(), green.end(), output.answer.begin(), output.answer.end()));
}

/// Leaves the batch wherever it can be left, and lets another session draw then.
void run_in_slices(RenderNode& node, Executor& executor, std::span<const std::byte> payload) {
    if (!executor.start_batch(payload)) return;
    for (int slices = 0;; ++slices) {
        const auto done = executor.run_slice({.until = {}});
        if (!done || *done) return;
        if (slices < kOthersTurns) check_others(node);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Node* node = new Node;
    {
        Ignore output;
        SessionReplica session(*node->driver, SessionId(1));
        session.objects.set_limits(kObjectBytes, kMaxObjects);
        session.set_most_pixels(kPixels);
        Executor executor(*node->node, session, output);
        open_surface(executor);
        (void)executor.run_batch(fuzz::batch_of(data, size, ContextId(1)));
    }
    {
        Ignore output;
        SessionReplica session(*node->driver, SessionId(1));
        session.objects.set_limits(kObjectBytes, kMaxObjects);
        session.set_most_pixels(kPixels);
        Executor executor(*node->node, session, output);
        open_surface(executor);
        const auto batch = fuzz::batch_of(data, size, ContextId(1));
        run_in_slices(*node->node, executor, batch);
    }
    {
        Ignore output;
        ParallelGroup group(*node->driver, {2, {}});
        group.set_most_pixels(kPixels);
        SessionReplica member(*node->driver, SessionId(1), &group, 0), other(*node->driver, SessionId(1), &group, 1);
        member.objects.set_limits(kObjectBytes, kMaxObjects);
        other.objects.set_limits(kObjectBytes, kMaxObjects);
        Executor executor(*node->node, member, output), others(*node->node, other, output);
        WALL_ASSERT(group.sync.join(0) && group.sync.join(1));
        open_surface(executor);
        open_surface(others);
        const auto batch = fuzz::batch_of(data, size, ContextId(1));
        (void)executor.run_batch(batch);
        (void)others.run_batch(batch);
        wall::tileserver::Work work;
        group.finish_frames(*node->node, work);
        (void)group.sync.deadlock();
    }
    check_others(*node->node);
    return 0;
}
