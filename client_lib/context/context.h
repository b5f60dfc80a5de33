// SPDX-License-Identifier: MIT
// A virtual OpenGL context: the complete state as the program set it, the geometry since the last change, and the
// table of functions that is its mode. It is the recovery log: any node can be given all of it at any time.
// Used by the one thread that has it current.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "client_lib/context/current.h"
#include "client_lib/context/matrix.h"
#include "client_lib/context/profile.h"
#include "client_lib/context/texture_units.h"
#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/session.h"
#include "client_lib/geometry/packer.h"
#include "common/glapi/recorder.h"
#include "common/glstate/diff.h"
#include "common/glstate/projection.h"
#include "common/wire/limits.h"
#include "gen/client_lib/api.gen.h"

namespace wall::client {

struct ShareGroup;         // objects/share_group.h: objects
struct ListState;          // list_state.h: display list being compiled, call nesting
struct AttributeStacks;    // attribute_stack.h
struct SelectState;        // select.h: feedback and selection
struct Program;            // objects/program.h
struct QueryState;         // query_state.h
struct ContextMaps;        // objects/maps.h: evaluator and pixel maps
struct BufferUse;          // buffer_use.h
class VertexInputs;        // vertex_inputs.h
struct DebugState;         // debug_state.h
class VertexArrayObjects;  // vertex_array_objects.h
class ArrayCopies;         // array_copies.h
struct StagingBuffers;     // staging_buffers.h
struct FramebufferUse;     // framebuffer_use.h

inline constexpr unsigned kVertexAttributes = glstate::el::vertex_attrib::count;
/// A block larger than this is sent at the next glEnd, so that nodes draw while the program goes on.
inline constexpr std::size_t kBlockBytes = 256 << 10;

/// One matrix stack; the top is the element of glstate::State.
struct MatrixStack {
    std::vector<FormedMatrix> below;       ///< saved by glPushMatrix, oldest first
    std::uint32_t form = form::kIdentity;  ///< the top's
    MatrixOrigin origin{};                 ///< the top's
    unsigned limit = 32;
};

class Context final : private UsedObjects {
public:
    explicit Context(std::shared_ptr<ShareGroup> share, const ContextProfile& profile = {});
    ~Context();
    Context(const Context&) = delete;

    const ContextId id;
    const ContextProfile profile;
    glstate::State state;
    const GlTable* table = nullptr;
    /// Commands are executed: not between glBegin and glEnd, and no list is compiled.
    bool at_once() const { return table == &at_once_; }
    Packer packer;

    template <class E>
    const typename E::type& get(unsigned i = 0) const {
        return E::ref(state, i);
    }
    /// Sets an element. An equal value is no change; otherwise what was drawn before is sent off with the old value.
    template <class E>
    void set(unsigned i, const typename E::type& value) {
        if (glstate::same(E::ref(state, i), value)) return;
        if constexpr (E::sent) flush_block();
        glstate::assign<E>(state, i, value);
    }

    /// Records an OpenGL error; the first one since the last glGetError stays.
    /// `where`: the function that found it, for people.
    void error(GLenum code, const char* where = __builtin_FUNCTION()) {
        if (error_ == GL_NO_ERROR) error_ = code;
        if (state.local.debug_output) report_error(code, where);
    }
    GLenum take_error() { return std::exchange(error_, GLenum{GL_NO_ERROR}); }

    /// Sends off the geometry packed so far. Current attributes and materials are in `state` after it. Cheap if empty.
    void flush_block() {
        if (!packer.empty()) submit_block();
    }
    /// Everything goes out; `wait`: and the nodes have executed it.
    void flush(bool wait) {
        flush_block();
        session_->flush(draw_target(), wait);
    }
    /// Draws with a command other than vertices. `box`: what it touches, in window pixels; nothing: unknown.
    template <class Pack>
    void draw(const std::optional<PixelRect>& box, Pack&& pack) {
        draw(box, Needs{}, std::forward<Pack>(pack));
    }
    /// The same for a command that depends on a part of the state only.
    template <class Pack>
    void draw(const std::optional<PixelRect>& box, const Needs& needs, Pack&& pack) {
        flush_block();
        if (!draws_nothing) session_->draw(draw_source(), box, needs, std::forward<Pack>(pack));
    }

    ClientSession& session() { return *session_; }
    bool attached() const { return session_ != nullptr; }
    /// What the wall's nodes can do; of a context that is not attached, nothing.
    const Caps& caps() const;
    ShareGroup& share() const { return *share_; }
    const std::shared_ptr<ShareGroup>& share_pointer() const { return share_; }
    /// It is current without a surface: there is no framebuffer but those that the program makes.
    bool has_no_surface() const;
    /// What its commands draw to now, and what they read from.
    DrawTarget draw_target() const;
    DrawTarget read_target() const;
    /// What the session needs to send one of its commands; flush_block() comes first.
    DrawSource draw_source();
    /// Conditional rendering has decided that drawing and clearing have no effect.
    bool draws_nothing = false;
    unsigned active_texture() const { return state.local.active_texture - GL_TEXTURE0; }
    /// Whether the active unit is one of fixed function: it has a switch, an environment, coordinates and a matrix.
    bool fixed_unit() const { return active_texture() < kTextureCoords; }

    // ---- parts by subject, each with its own header ----
    MatrixStack modelview_stack, projection_stack;
    std::array<MatrixStack, kTextureCoords> texture_stacks;
    std::unique_ptr<ListState> lists;
    std::unique_ptr<AttributeStacks> attributes;
    std::unique_ptr<SelectState> select;
    glapi::ListRecorder& list();  ///< of the list being compiled
    std::unique_ptr<ContextMaps> maps;
    std::unique_ptr<BufferUse> buffers;
    std::unique_ptr<VertexInputs> inputs;
    std::unique_ptr<FramebufferUse> framebuffers;
    std::unique_ptr<VertexArrayObjects> vertex_array_objects;
    std::unique_ptr<StagingBuffers> staging;
    std::unique_ptr<ArrayCopies> copies;
    std::shared_ptr<Program> program;  ///< drawn with; null: fixed function
    std::unique_ptr<QueryState> queries;
    std::unique_ptr<DebugState> debug;

    /// Before an object that was drawn with changes or goes: by its id.
    void before_change(ClientName changing_id) {
        if (session_) session_->hidden_parts([&](HiddenParts& parts) { parts.before_object_changes(changing_id); });
    }

    /// An object of the nodes that nothing names any more.
    void forget_object(ClientName gone);

    /// glBegin and glEnd after their checks.
    void begin_primitive(GLenum mode);
    void end_primitive();

    /// A driver looks at the modelview matrix when it draws.
    void determine_modelview_form();

    /// Before its first use; the connection is made no earlier. Whoever destroys it afterwards tells the session.
    void attach(std::shared_ptr<ClientSession> session) { session_ = std::move(session); }
    void bind_surfaces(std::shared_ptr<ClientSurface> draw, std::shared_ptr<ClientSurface> read);
    const glstate::Projection& projection();

    std::atomic<bool> in_use{false};  ///< current in some thread

    /// After a failure of ours in the middle of a command: nothing is drawn with it any more.
    void lose();
    bool lost() const { return lost_; }

private:
    void for_each_used(const std::function<void(const Object&)>& use) override;
    void submit_block();
    void report_error(GLenum code, const char* where);
    void first_use();

    const GlTable& at_once_;  ///< its mode while it executes commands
    std::shared_ptr<ClientSession> session_;
    std::shared_ptr<ShareGroup> share_;
    std::shared_ptr<ClientSurface> draw_, read_;
    GLenum error_ = GL_NO_ERROR;
    bool used_ = false;
    bool lost_ = false;
    glstate::Projection projection_;
    std::array<std::uint64_t, 3> projection_ids_{};
};

}  // namespace wall::client
