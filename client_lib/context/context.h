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
struct PipelineUse;        // objects/program_pipeline.h
struct QueryState;         // query_state.h
struct ContextMaps;        // objects/maps.h: evaluator and pixel maps
struct BufferUse;          // buffer_use.h
class VertexInputs;        // vertex_inputs.h
struct DebugState;         // debug_state.h
class VertexArrayObjects;  // vertex_array_objects.h
class ArrayCopies;         // array_copies.h
struct StagingBuffers;     // staging_buffers.h
struct FramebufferUse;     // framebuffer_use.h
class CaptureUse;          // capture_use.h: transform feedback
struct MemoryUse;          // memory_use.h: what shaders write
struct AssemblyUse;        // assembly_use.h: programs of GL_ARB_vertex_program and GL_ARB_fragment_program

inline constexpr unsigned kVertexAttributes = glstate::el::vertex_attrib::count;
/// A block larger than this is sent at the next glEnd, so that nodes draw while the program goes on.
inline constexpr std::size_t kBlockBytes = 256 << 10;

/// Where vertices go on the window, as far as that is known before they are drawn.
struct Placing {
    bool known = false;                ///< false: a shader puts them anywhere
    std::uint32_t attribute = 0;       ///< generic one that a shader makes the position of; 0: or glVertex's
    bool homogeneous = true;           ///< multiples of a vertex are in the same place
    glstate::Projection projection{};  ///< of (x, y, z, 1); if not known, of one where all may be anywhere
    bool steady = true;                ///< single triangles have no margin for a shader's rounding
    bool of_vertices() const { return known && attribute == 0 && steady; }
};

/// Of each matrix that assembly programs alone read, as in Mesa.
inline constexpr unsigned kProgramStackLimit = 4;

/// Which of these a matrix mode is of; nothing: another one.
inline std::optional<unsigned> program_matrix_of(GLenum mode) {
    const bool found = mode >= GL_MATRIX0_ARB && mode < GL_MATRIX0_ARB + glstate::el::program_matrix::count;
    return found ? std::optional(mode - GL_MATRIX0_ARB) : std::nullopt;
}

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
        // Nodes are not told of what is discarded, but what was drawn before is drawn.
        if constexpr (E::sent || E::id == glstate::el::rasterizer_discard::id) flush_block();
        glstate::assign<E>(state, i, value);
    }

    /// Records an OpenGL error; the first one since the last glGetError stays.
    /// `where`: the function that found it, for people.
    void error(GLenum code, const char* where = __builtin_FUNCTION()) {
        if (error_ == GL_NO_ERROR) error_ = code;
        report_error(code, where);
    }
    /// At the end of a command, when no mutex is held: the program's callback may call any command.
    void tell_errors() {
        if (has_untold_) tell();
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
    /// Draws with a command other than vertices.
    template <class Pack>
    void draw(const Drawn& drawn, Pack&& pack) {
        draw(drawn, Needs{}, std::forward<Pack>(pack));
    }
    /// The same for a command that depends on a part of the state only.
    template <class Pack>
    void draw(const Drawn& drawn, const Needs& needs, Pack&& pack) {
        flush_block();
        if (draws_nothing || state.local.rasterizer_discard) return;
        session_->draw(draw_source(), drawn, needs, std::forward<Pack>(pack));
    }

    ClientSession& session() { return *session_; }
    bool attached() const { return session_ != nullptr; }
    /// What the wall's nodes can do; of a context that is not attached, nothing.
    const Caps& caps() const;
    ShareGroup& share() const { return *share_; }
    const std::shared_ptr<ShareGroup>& share_pointer() const { return share_; }
    /// It is current without a surface: there is no framebuffer but those that the program makes.
    bool has_no_surface() const;
    /// The window that is read from is the one that is drawn to.
    bool reads_drawn_surface() const { return draw_ == read_; }
    /// Where no framebuffer object is read from; null: nothing is.
    ClientSurface* read_surface() const { return read_.get(); }
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
    std::array<MatrixStack, glstate::el::program_matrix::count> program_stacks;
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
    std::unique_ptr<PipelineUse> pipelines;
    std::unique_ptr<QueryState> queries;
    std::unique_ptr<DebugState> debug;
    std::unique_ptr<CaptureUse> captures;
    std::unique_ptr<MemoryUse> memory;
    std::unique_ptr<AssemblyUse> assembly;
    /// Of a target that a command does not work on; where the texture was named, that is no word of the call.
    GLenum target_error = GL_INVALID_ENUM;

    /// Before an object that was drawn with changes or goes: by its id.
    void before_change(ClientName changing_id) {
        if (session_) session_->before_object_changes(changing_id);
    }

    /// An object of the nodes that nothing names any more.
    void forget_object(ClientName gone);

    /// glBegin and glEnd after their checks.
    void begin_primitive(GLenum mode);
    void end_primitive();

    /// Before a draw of what is seen: where its program may write memory, all nodes draw all of the window.
    void before_writing_draw();

    /// A driver looks at the modelview matrix when it draws.
    void determine_modelview_form();

    /// Before its first use; the connection is made no earlier. Whoever destroys it afterwards tells the session.
    void attach(std::shared_ptr<ClientSession> session) { session_ = std::move(session); }
    void bind_surfaces(std::shared_ptr<ClientSurface> draw, std::shared_ptr<ClientSurface> read);
    const glstate::Projection& projection();
    /// Where the vertices that are drawn now go: as `projection()` says, or the program.
    const Placing& placing();
    /// A program may put vertices anywhere, and read what it likes.
    bool shades_vertices() const { return program || state.objects.vertex_program_enabled != 0; }

    std::atomic<bool> in_use{false};  ///< current in some thread

    /// After a failure of ours in the middle of a command: nothing is drawn with it any more.
    void lose();
    bool lost() const { return lost_; }

private:
    void for_each_used(const std::function<void(const Object&)>& use) override;
    bool writes() override;
    void for_each_written(const std::function<void(const Object&)>& use) override;
    void note_written() override;
    void set_first_state();
    void submit_block();
    /// Whether the boxes of what is packed tell where a program puts it.
    bool places_packed_vertices();
    void report_error(GLenum code, const char* where);
    void tell();
    void submit_geometry();
    void first_use();

    const GlTable& at_once_;  ///< its mode while it executes commands
    std::shared_ptr<ClientSession> session_;
    std::shared_ptr<ShareGroup> share_;
    std::shared_ptr<ClientSurface> draw_, read_;
    bool has_untold_ = false;  ///< debug->untold is not empty
    GLenum error_ = GL_NO_ERROR;
    bool used_ = false;
    bool lost_ = false;
    glstate::Projection projection_;
    std::array<std::uint64_t, 5> projection_ids_{};
    /// What the placing follows from.
    struct PlacedFrom {
        std::uint64_t change = 0;  ///< of the program; 0: of none
        std::array<std::uint64_t, 5> projection{};
        std::uint64_t environment = 0;  ///< of an assembly program's parameters
        bool operator==(const PlacedFrom&) const = default;
    };
    /// False: that is what it follows from already.
    bool is_placed_anew(const PlacedFrom& from) { return std::exchange(placed_from_, from) != from; }
    /// By a position program; the share group's mutex is held.
    void place(glapi::LinkedPosition& position, GLint attribute);

    Placing placing_;
    PlacedFrom placed_from_;
};

}  // namespace wall::client
