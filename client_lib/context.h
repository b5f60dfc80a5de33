// SPDX-License-Identifier: MIT
// A virtual OpenGL context: the complete state as the program set it, the geometry since the last change, and the
// table of functions that is its mode. It is the recovery log: any node can be given all of it at any time.
// Used by the one thread that has it current.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "client_lib/core.h"
#include "client_lib/current.h"
#include "client_lib/packer.h"
#include "client_lib/router.h"
#include "client_lib/session.h"
#include "gen/client_lib/api.gen.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

struct ShareGroup;      // share_group.h: objects
struct ListState;       // lists.h: display list being compiled, call nesting
struct AttributeStacks; // attribute_stack.h
struct SelectState;     // select.h: feedback and selection

inline constexpr unsigned kTextureUnits = 8;

/// One matrix stack; the top is the element of glstate::State.
struct MatrixStack {
    std::vector<glstate::Mat4> below;  ///< saved by glPushMatrix, oldest first
    unsigned limit = 32;
};

class Context {
public:
    Context(std::shared_ptr<Session> session, std::shared_ptr<ShareGroup> share, const ContextOptions& options);
    ~Context();
    Context(const Context&) = delete;

    const std::uint32_t id;
    glstate::State state;
    const GlTable* table = nullptr;
    Packer packer;

    template <class E>
    const typename E::type& get(unsigned i = 0) const {
        return E::ref(state, i);
    }
    /// Sets an element. An equal value is no change; otherwise what was drawn before is sent off with the old value.
    template <class E>
    void set(unsigned i, const typename E::type& value) {
        if (E::ref(state, i) == value) return;
        flush_block();
        glstate::assign<E>(state, i, value);
    }

    /// Records an OpenGL error; the first one since the last glGetError stays.
    void error(GLenum code) {
        if (error_ == GL_NO_ERROR) error_ = code;
    }
    GLenum take_error() { return std::exchange(error_, GLenum{GL_NO_ERROR}); }

    /// Sends off the geometry packed so far. Current attributes and materials are in `state` after it. Cheap if empty.
    void flush_block() {
        if (!packer.empty()) submit_block();
    }
    /// Draws with a command other than vertices. `box`: what it touches, in window pixels; nothing: unknown.
    template <class Pack>
    void draw(const std::optional<PixelRect>& box, Pack&& pack) {
        flush_block();
        session_->draw(*this, box, std::forward<Pack>(pack));
    }

    Session& session() { return *session_; }
    ShareGroup& share() { return *share_; }
    const std::shared_ptr<ShareGroup>& share_pointer() const { return share_; }
    Surface* draw_surface() const { return draw_.get(); }
    Surface* read_surface() const { return read_.get(); }
    unsigned active_texture() const { return state.local.active_texture - GL_TEXTURE0; }

    // ---- parts by subject, each with its own header ----
    MatrixStack modelview_stack, projection_stack;
    std::array<MatrixStack, kTextureUnits> texture_stacks;
    std::unique_ptr<ListState> lists;
    std::unique_ptr<AttributeStacks> attributes;
    std::unique_ptr<SelectState> select;

    /// glMaterial calls inside the open Begin/End, applied to `state` when the block is sent.
    struct PendingMaterial {
        GLenum face, pname;
        std::array<float, 4> value;
    };
    std::vector<PendingMaterial> pending_materials;

    void bind_surfaces(std::shared_ptr<Surface> draw, std::shared_ptr<Surface> read);
    const Projection& projection();

    std::atomic<bool> in_use{false};  ///< current in some thread

private:
    void submit_block();
    void first_use();

    std::shared_ptr<Session> session_;
    std::shared_ptr<ShareGroup> share_;
    std::shared_ptr<Surface> draw_, read_;
    GLenum error_ = GL_NO_ERROR;
    bool used_ = false;
    Projection projection_;
    std::array<std::uint64_t, 3> projection_ids_{};
};

}  // namespace wall::client
