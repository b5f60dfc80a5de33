// SPDX-License-Identifier: MIT
#include "client_lib/context/captured_draw.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

/// The arrays as the nodes know them; null: they do not lie in buffers that the nodes can have as they are.
VertexInput* input_on_nodes(Context& c) {
    if (buffers_were_deleted(c)) let_go_of_deleted_buffers(c);
    VertexInput* input = c.inputs->current(c.state, *c.buffers, c.share(), false);
    forget_inputs(c, c.inputs->take_unused());
    if (!input) return nullptr;
    std::lock_guard lock(c.share().mutex);
    const InputFacts& facts = input->facts();
    return facts.blocked || facts.written_unseen ? nullptr : input;
}

/// One round trip.
GLsizei ask_count(Context& c, const CapturedDraw& draw) {
    const auto answer =
        ask_one_node(c, "glDrawTransformFeedback", [&](wire::PackBuffer& batch, RequestId request, Node& node) {
            {
                std::lock_guard lock(c.share().mutex);
                ObjectSender(c.session().nodes(), node, batch).send(*draw.capture);
            }
            glapi::pack::CaptureCounts(batch, request, draw.capture->id);
        });
    std::array<std::uint64_t, kVertexStreams> counts{};
    if (answer && answer->bytes.size() == sizeof counts)
        std::memcpy(counts.data(), answer->bytes.data(), sizeof counts);
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<GLsizei>::max());
    return static_cast<GLsizei>(std::min(counts[draw.stream], kMost));
}

class DrawOnNodes {
public:
    DrawOnNodes(Context& c, const VertexInput& input, const CapturedDraw& draw) : c_(c), input_(input), draw_(draw) {}

    void send() {
        c_.session().draw(c_.draw_source(), Drawn::anywhere(c_.placing().projection), needs_of_geometry(c_.state),
                          *this, [&](wire::PackBuffer& buffer) {
                              glapi::pack::DrawCaptured(buffer, input_.id, draw_.capture->id, draw_.mode, draw_.stream,
                                                        draw_.instances);
                          });
    }

    // ---- what it names (named_objects.h) ----
    bool are_on(const Node&) const { return false; }
    template <class Use>
    void for_each(Use&& use) const {
        for (const auto& buffer : input_.buffers()) use(*buffer);
        use(input_);
        use(*draw_.capture);
    }
    void note_on(Node&) const {}
    void note_drawn(Node&) const {}

private:
    Context& c_;
    const VertexInput& input_;
    const CapturedDraw& draw_;
};

}  // namespace

GLuint vertex_streams(const Context& c) {
    if (!c.attached()) return kVertexStreams;
    return static_cast<GLuint>(std::clamp(limit_of(c.caps(), GL_MAX_VERTEX_STREAMS, 1), 1.0, double{kVertexStreams}));
}

void draw_captured(Context& c, const CapturedDraw& draw) {
    c.flush_block();
    if (!c.draw_target()) return;
    const VertexInput* input = input_on_nodes(c);
    if (!input) return c.table->DrawArraysInstanced(c, draw.mode, 0, ask_count(c, draw), draw.instances);
    if (!input->positions() && !c.shades_vertices()) return;  // there is nothing to draw
    if (!may_draw(c) || c.draws_nothing) return;
    c.determine_modelview_form();
    draw_in_passes(c.state, *c.captures, [&] { DrawOnNodes(c, *input, draw).send(); });
}

}  // namespace wall::client
