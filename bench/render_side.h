// SPDX-License-Identifier: MIT
// A tileserver's render side for benchmarks: without threads and sockets, on a driver that does nothing or on llvmpipe.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "common/base/assert.h"
#include "common/wire/batch.h"
#include "gen/glapi/wire.gen.h"
#include "tileserver/execute/executor.h"
#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/memory.h"

namespace wall::tileserver::bench {

inline constexpr int kSize = 256;  ///< pixels of every window, each way

/// Takes every command and does nothing. Callers pass more than it reads, which this machine's calling convention
/// allows.
inline long nothing() { return 0; }
inline GLenum complete(GLenum) { return GL_FRAMEBUFFER_COMPLETE; }

class NullBackend final : public GlBackend {
public:
    Result<void> make_current() override { return {}; }
    void* get_proc_address(const char* name) const override {
        return std::string_view(name) == "glCheckFramebufferStatus" ? reinterpret_cast<void*>(&complete)
                                                                    : reinterpret_cast<void*>(&nothing);
    }
    std::string_view name() const override { return "null"; }
};

enum class To { null, llvmpipe };

struct Ignore final : SessionOutput {
    void reply(RequestId, std::vector<std::byte>) override {}
    void frame_rendered(SurfaceId, std::uint32_t) override {}
    void partial(NodeIndex, std::vector<std::byte>) override {}
};

/// A tileserver's render side with one tile and sessions that each have a window on it and two contexts.
class Node {
public:
    explicit Node(To to) {
        keep_freed_memory();  // as the tileserver does
        if (to == To::null) {
            backend_ = std::make_unique<NullBackend>();
        } else {
            auto opened = open_egl_backend();
            WALL_ASSERT(opened);
            backend_ = std::move(*opened);
        }
        WALL_ASSERT(backend_->make_current());
        Gl gl;
        gl.load([this](const char* name) { return backend_->get_proc_address(name); });
        driver_ = std::make_unique<Driver>(gl);
        node_ = std::make_unique<RenderNode>(*driver_);
        node_->tiles = {{0, {0, 0, kSize, kSize}}};
    }
    RenderNode& node() { return *node_; }
    const Gl& gl() const { return driver_->gl(); }

private:
    std::unique_ptr<GlBackend> backend_;
    std::unique_ptr<Driver> driver_;
    std::unique_ptr<RenderNode> node_;
};

class Client {
public:
    Client(Node& node, SessionId id) : session(node.node().driver, id), executor(node.node(), session, output_) {
        wire::PackBuffer buffer;
        glapi::pack::SurfaceCreate(buffer, SurfaceId(1), 1, 8, 24, 8, 0, 0, 1, 0);
        glapi::pack::SurfacePlace(buffer, SurfaceId(1), 1, kSize, kSize, 0, 0, kSize, kSize, 0);
        run(ContextId(1), buffer);
        for (const ContextId context : {ContextId(1), ContextId(2)}) {
            wire::PackBuffer bind;
            glapi::pack::Bind(bind, SurfaceId(1), SurfaceId(1));
            run(context, bind);
            glstate::assign<glstate::el::viewport>(this->context(context).state, 0, {0, 0, kSize, kSize});
        }
    }
    void run(ContextId context, const wire::PackBuffer& buffer) {
        std::vector<std::byte> payload;
        wire::append_batch(payload, {context, buffer.opcodes(), buffer.operands()});
        WALL_ASSERT(executor.run_batch(payload));
    }
    SoftContext& context(ContextId id) { return session.context(id); }
    Layer& layer() { return *session.surface(SurfaceId(1))->layer(0); }

private:
    Ignore output_;  // before what uses it

public:
    SessionReplica session;
    Executor executor;
};

}  // namespace wall::tileserver::bench
