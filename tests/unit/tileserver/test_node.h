// SPDX-License-Identifier: MIT
// A node's render side without threads and sockets: a backend, a driver, sessions that are fed packed commands.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "common/base/assert.h"
#include "common/wire/batch.h"
#include "gen/glapi/wire.gen.h"
#include "tests/unit/tileserver/reference_window.h"
#include "tileserver/execute/executor.h"
#include "tileserver/gpu/backend.h"

namespace wall::tileserver::test {

namespace el = glstate::el;
namespace pack = glapi::pack;

/// Packed commands of one context; blocks() wraps drawing.
class Batch {
public:
    explicit Batch(ContextId context = ContextId(1)) : context_(context) {}
    wire::PackBuffer& buffer() { return buffer_; }
    template <class E>
    Batch& set(const typename E::type& value, unsigned i = 0) {
        glapi::pack_state(buffer_, static_cast<std::uint16_t>(E::id + i), &value, sizeof value);
        return *this;
    }
    template <class Draw>
    Batch& block(std::uint64_t tiles, Draw&& draw) {
        wire::PackBuffer body;
        draw(body);
        pack::Block(buffer_, static_cast<std::uint32_t>(tiles), static_cast<std::uint32_t>(tiles >> 32),
                    static_cast<std::uint32_t>(body.commands()), static_cast<std::uint32_t>(body.operand_bytes()));
        buffer_.append(body, {}, body.mark());
        return *this;
    }
    std::vector<std::byte> payload() const {
        std::vector<std::byte> bytes;
        wire::append_batch(bytes, {context_, buffer_.opcodes(), buffer_.operands()});
        return bytes;
    }

private:
    ContextId context_;
    wire::PackBuffer buffer_;
};

/// What a session was fed in context 1, but for its window, as an input of fuzz_executor. At the end it is written to
/// the folder that WALLGL_SEEDS names, if it does, as TEST-N (docs/how-to-extend.md).
class Seed {
public:
    ~Seed();
    void add(std::span<const std::byte> payload);

private:
    std::vector<std::byte> opcodes_, operands_;
};

class TestSession : public SessionOutput {
public:
    TestSession(RenderNode& node, SessionId id, ParallelGroup* group = nullptr, Rank rank = 0)
        : session(node.driver, id, group, rank), executor(node, session, *this) {}
    void reply(RequestId request, std::vector<std::byte> answer) override { replies[request] = std::move(answer); }
    void frame_rendered(SurfaceId surface, std::uint32_t frame) override { frames.push_back({surface.value, frame}); }
    void partial(NodeIndex to, std::vector<std::byte> message) override {
        partials.emplace_back(to, std::move(message));
    }
    std::vector<std::pair<NodeIndex, std::vector<std::byte>>> partials;

    Result<void> run(const Batch& batch) {
        const auto payload = batch.payload();
        seed.add(payload);
        return executor.run_batch(payload);
    }
    void expect_run(const Batch& batch) {
        const auto done = run(batch);
        EXPECT_TRUE(done) << done.error().message;
    }
    /// A double-buffered surface 1 of the given window at a place on the canvas, bound to context 1.
    void open_surface(int window_width, int window_height, const geom::Rect& rect, ContextId context = ContextId(1),
                      bool alpha = false);
    /// RGBA of the back buffer on one tile, bottom row first, the part (x, y, width, height) of the window.
    Pixels read(std::uint32_t slot, const geom::Rect& part, ContextId context = ContextId(1));

    static constexpr RequestId kReadRequest{99};  ///< of read()
    std::map<RequestId, std::vector<std::byte>> replies;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> frames;
    SessionReplica session;
    Executor executor;
    Seed seed;
};

class TestNode {
public:
    /// `change`: of the driver's functions.
    explicit TestNode(std::string_view backend = "egl", void (*change)(Gl& gl) = nullptr);
    ~TestNode();
    bool usable() const { return driver != nullptr; }
    void make_current() { WALL_ASSERT((*backend_)->make_current()); }

    std::unique_ptr<Driver> driver;
    std::unique_ptr<RenderNode> node;

private:
    Result<std::unique_ptr<GlBackend>> backend_;
};

}  // namespace wall::tileserver::test
