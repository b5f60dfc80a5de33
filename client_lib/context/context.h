// SPDX-License-Identifier: MIT
// A virtual OpenGL context: the complete state as the program set it, the geometry since the last change, and the
// table of functions that is its mode. It is the recovery log: any node can be given all of it at any time.
// Used by the one thread that has it current.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "client_lib/context/core.h"
#include "client_lib/context/current.h"
#include "client_lib/context/matrix.h"
#include "client_lib/follow/session.h"
#include "client_lib/geometry/packer.h"
#include "client_lib/geometry/router.h"
#include "common/glapi/recorder.h"
#include "common/glstate/diff.h"
#include "common/wire/limits.h"
#include "gen/client_lib/api.gen.h"

namespace wall::client {

struct ShareGroup;       // share_group.h: objects
struct ListState;        // lists.h: display list being compiled, call nesting
struct AttributeStacks;  // attribute_stack.h
struct SelectState;      // select.h: feedback and selection
struct Program;          // objects/program.h
struct OcclusionState;   // occlusion.h
struct ContextMaps;      // maps.h: evaluator and pixel maps
struct BufferUse;        // buffer_binding.h

inline constexpr unsigned kTextureUnits = glstate::el::texture_binding_2d::count;
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

class Context {
public:
    Context(std::shared_ptr<ShareGroup> share, const ContextOptions& options);
    ~Context();
    Context(const Context&) = delete;

    const ContextId id;
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
        if (glstate::same(E::ref(state, i), value)) return;
        if constexpr (E::category != glstate::Category::local) flush_block();
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
        draw(box, Needs{}, std::forward<Pack>(pack));
    }
    /// The same for a command that depends on a part of the state only.
    template <class Pack>
    void draw(const std::optional<PixelRect>& box, const Needs& needs, Pack&& pack) {
        flush_block();
        session_->draw(*this, box, needs, std::forward<Pack>(pack));
    }

    ClientSession& session() { return *session_; }
    ShareGroup& share() const { return *share_; }
    const std::shared_ptr<ShareGroup>& share_pointer() const { return share_; }
    ClientSurface* draw_surface() const { return draw_.get(); }
    ClientSurface* read_surface() const { return read_.get(); }
    unsigned active_texture() const { return state.local.active_texture - GL_TEXTURE0; }

    // ---- parts by subject, each with its own header ----
    MatrixStack modelview_stack, projection_stack;
    std::array<MatrixStack, kTextureUnits> texture_stacks;
    std::unique_ptr<ListState> lists;
    std::unique_ptr<AttributeStacks> attributes;
    std::unique_ptr<SelectState> select;
    glapi::ListRecorder& list();  ///< of the list being compiled
    std::unique_ptr<ContextMaps> maps;
    std::unique_ptr<BufferUse> buffers;
    std::shared_ptr<Program> program;  ///< drawn with; null: fixed function
    std::unique_ptr<OcclusionState> occlusion;

    /// glMaterial calls inside the open Begin/End, applied to `state` when the block is sent.
    struct PendingMaterial {
        GLenum face, pname;
        std::array<float, 4> value;
    };
    std::vector<PendingMaterial> pending_materials;

    /// Before an object that was drawn with changes or goes: by its id.
    void before_change(ClientName changing_id) {
        if (session_) session_->before_object_changes(changing_id);
    }

    /// glBegin and glEnd after their checks.
    void begin_primitive(GLenum mode);
    void end_primitive();

    /// A driver looks at the modelview matrix when it draws.
    void determine_modelview_form();

    /// Moves the packed block's last attributes and materials into `state` (BlockSender).
    void fold_attributes();
    bool folded_material() const { return folded_material_; }
    /// Where the draw surface lies: its tiles, or one offscreen layer while selecting or in feedback.
    const SurfaceLayout& draw_layout() const;

    /// Before its first use; the connection is made no earlier.
    void attach(std::shared_ptr<ClientSession> session) { session_ = std::move(session); }
    void bind_surfaces(std::shared_ptr<ClientSurface> draw, std::shared_ptr<ClientSurface> read);
    const Projection& projection();

    std::atomic<bool> in_use{false};  ///< current in some thread

    /// After a failure of ours in the middle of a command: nothing is drawn with it any more.
    void lose();
    bool lost() const { return lost_; }

private:
    void submit_block();
    void forget_block();
    void first_use();

    std::shared_ptr<ClientSession> session_;
    std::shared_ptr<ShareGroup> share_;
    std::shared_ptr<ClientSurface> draw_, read_;
    GLenum error_ = GL_NO_ERROR;
    bool used_ = false;
    bool lost_ = false;
    bool folded_material_ = false;
    Projection projection_;
    std::array<std::uint64_t, 3> projection_ids_{};
};

template <class Pack>
void ClientSession::draw(Context& context, const std::optional<PixelRect>& box, const Needs& needs, Pack&& pack) {
    draw(
        context, box, needs, [](Node&, wire::PackBuffer&) {}, std::forward<Pack>(pack), [](Node&) {});
}

template <class Before, class Pack, class After>
void ClientSession::draw(Context& context, const std::optional<PixelRect>& box, const Needs& needs, Before&& before,
                         Pack&& pack, After&& after) {
    packing([&] {
        if (!context.draw_surface()) return;
        const auto pack_block = [&](wire::PackBuffer& buffer, std::uint64_t slots) {
            const std::size_t operands = buffer.operand_bytes();
            glapi::pack::Block(buffer, static_cast<std::uint32_t>(slots), static_cast<std::uint32_t>(slots >> 32), 0,
                               0);
            const auto start = buffer.mark();
            pack(buffer);
            const auto end = buffer.mark();
            const std::uint32_t counts[2] = {static_cast<std::uint32_t>(end.commands - start.commands),
                                             static_cast<std::uint32_t>(end.operand_bytes - start.operand_bytes)};
            std::memcpy(buffer.operand_at(operands + 8), counts, sizeof counts);
        };
        if (Node* kept = context.draw_surface()->hidden ? begin_keeping(context, box) : nullptr) {
            Node& node = node_of(kept->index);
            before(node, batch(node, context.id));
            pack_block(prepare_kept(context, needs), std::uint64_t{1} << wire::kOffscreenSlot);
            after(*kept);
        }
        const SurfaceLayout& layout = context.draw_layout();
        for (const auto& [index, slots] : targets_of(layout, box)) {
            Node& node = node_of(index);
            if (!node.takes(context.draw_surface()->id)) continue;
            wire::PackBuffer& buffer = prepare(node, context, needs);
            before(node, buffer);
            const std::size_t bytes = buffer.bytes();
            pack_block(buffer, slots);
            count_geometry(node, buffer.bytes() - bytes);
            after(node);
        }
    });
}

template <class Pack>
void ClientSession::on_every_node(Context& context, Pack&& pack) {
    packing([&] {
        for (auto& node : nodes_)
            if (node->alive()) pack(batch(*node, context.id), *node);
    });
}

template <class Note, class Pack>
void ClientSession::synchronize(Context& context, bool at_once, Note&& note, Pack&& pack) {
    context.flush_block();
    packing([&] {
        if (const GLenum error = note(sync_); error != GL_NO_ERROR) return context.error(error);
        if (!group_) return;
        for (auto& node : nodes_) {
            if (!node->alive()) continue;
            pack(batch(*node, context.id));
            if (at_once) send(*node);
        }
    });
}

template <class Pack>
std::optional<std::vector<std::byte>> ClientSession::ask(Context& context, Node& node, const char* function,
                                                         Pack&& pack) {
    context.flush_block();
    std::shared_ptr<NodeStream> stream;  // the node may get another one meanwhile
    const RequestId request = packing([&] {
        if (!node.answers() || !context.draw_surface()) return RequestId();
        const RequestId next = next_request();
        pack(prepare(node, context), next);
        count_round_trip(function);
        send(node);
        stream = node.stream;
        return next;
    });
    if (!request) return std::nullopt;
    return stream->wait_reply(request, reply_timeout_ms());
}

template <class Pack>
std::vector<std::optional<std::vector<std::byte>>> ClientSession::ask_all(Context& context,
                                                                          const std::vector<Target>& targets,
                                                                          const char* function, Pack&& pack) {
    context.flush_block();
    std::vector<std::pair<std::shared_ptr<NodeStream>, RequestId>> asked;  // null: cannot be asked
    packing([&] {
        for (const Target& target : targets) {
            Node& node = node_of(target);
            asked.emplace_back(node.answers() && context.draw_surface() ? node.stream : nullptr, next_request());
            if (asked.back().first) pack(prepare(node, context), asked.back().second, asked.size() - 1);
        }
        for (const Target& target : targets) send(node_of(target));
        if (!targets.empty()) count_round_trip(function);
    });
    std::vector<std::optional<std::vector<std::byte>>> answers;
    for (const auto& [stream, request] : asked)
        answers.push_back(stream ? stream->wait_reply(request, reply_timeout_ms()) : std::nullopt);
    return answers;
}

}  // namespace wall::client
