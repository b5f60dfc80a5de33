// SPDX-License-Identifier: MIT
// Selection and feedback (OpenGL 1.2.1, 5.2 and 5.3).
#include "client_lib/context/select.h"

#include <algorithm>
#include <cstring>

#include "client_lib/context/context.h"

namespace wall::client::api {
namespace {

Node* first_alive(ClientSession& session) {
    std::lock_guard lock(session.mutex());
    for (auto& node : session.nodes())
        if (node->answers()) return node.get();
    return nullptr;
}

Node* selecting_node(Context& c) {
    if (!c.select->layer) return first_alive(c.session());
    std::lock_guard lock(c.session().mutex());
    return &c.session().nodes()[*c.select->layer];
}

/// Switches the node over; its answer: the result of the mode that ended, then its buffer.
std::vector<std::byte> switch_mode(Context& c, Node& node, GLenum mode) {
    const SelectState& s = *c.select;
    const GLsizei entries = mode == GL_SELECT ? s.select_entries : s.feedback_entries;
    const auto count = static_cast<std::uint32_t>(mode == GL_RENDER ? 0 : entries);
    auto answer =
        c.session().ask(c.draw_source(), node, "glRenderMode", [&](wire::PackBuffer& buffer, RequestId request) {
            glapi::pack::RenderMode(buffer, request, mode, s.feedback_type, count);
        });
    return std::move(answer).value_or(std::vector<std::byte>{});
}

/// Hands the answer to the application; returns glRenderMode's value.
GLint deliver(Context& c, GLenum ended, std::span<const std::byte> answer) {
    if (ended == GL_RENDER || answer.size() < sizeof(GLint)) return 0;
    GLint result = 0;
    std::memcpy(&result, answer.data(), sizeof result);
    const auto content = answer.subspan(sizeof result);
    const SelectState& s = *c.select;
    const bool selecting = ended == GL_SELECT;
    const auto room = static_cast<std::size_t>(selecting ? s.select_entries : s.feedback_entries) * sizeof(GLuint);
    void* to = selecting ? static_cast<void*>(s.select_buffer) : s.feedback_buffer;
    if (to) std::memcpy(to, content.data(), std::min(room, content.size()));
    return result;
}

bool selecting(const Context& c) { return c.state.local.render_mode == GL_SELECT; }

template <class Pack>
void send_name(Context& c, Pack&& pack) {
    c.draw(std::nullopt, std::forward<Pack>(pack));
}

}  // namespace

void SelectBuffer(Context& c, GLsizei size, GLuint* buffer) {
    if (size < 0) return c.error(GL_INVALID_VALUE);
    if (selecting(c)) return c.error(GL_INVALID_OPERATION);
    c.select->select_buffer = buffer;
    c.select->select_entries = size;
}

void FeedbackBuffer(Context& c, GLsizei size, GLenum type, GLfloat* buffer) {
    if (c.state.local.render_mode == GL_FEEDBACK) return c.error(GL_INVALID_OPERATION);
    if (size < 0 || (!buffer && size > 0)) return c.error(GL_INVALID_VALUE);
    if (type < GL_2D || type > GL_4D_COLOR_TEXTURE) return c.error(GL_INVALID_ENUM);
    c.select->feedback_buffer = buffer;
    c.select->feedback_entries = size;
    c.select->feedback_type = type;
}

GLint RenderMode(Context& c, GLenum mode) {
    const GLenum ended = c.state.local.render_mode;
    SelectState& s = *c.select;
    const bool known = mode == GL_RENDER || mode == GL_SELECT || mode == GL_FEEDBACK;
    if (!known) return c.error(GL_INVALID_ENUM), 0;
    if ((mode == GL_SELECT && s.select_entries < 0) || (mode == GL_FEEDBACK && s.feedback_entries < 0))
        return c.error(GL_INVALID_OPERATION), 0;
    if (ended == GL_RENDER && mode == GL_RENDER) return 0;
    c.flush_block();
    Node* node = c.draw_target() ? selecting_node(c) : nullptr;
    const auto answer = node ? switch_mode(c, *node, mode) : std::vector<std::byte>{};
    s.name_depth = 0;
    s.layer.reset();
    if (mode != GL_RENDER && node) {
        const auto [width, height] = c.draw_target().size();
        s.layer = whole_window(width, height, node->index);
    }
    glstate::assign<glstate::el::render_mode>(c.state, 0, mode);
    return deliver(c, ended, answer);
}

void InitNames(Context& c) {
    if (!selecting(c)) return;
    c.select->name_depth = 0;
    send_name(c, [](wire::PackBuffer& buffer) { glapi::pack::InitNames(buffer); });
}

void LoadName(Context& c, GLuint name) {
    if (!selecting(c)) return;
    if (c.select->name_depth == 0) return c.error(GL_INVALID_OPERATION);
    send_name(c, [&](wire::PackBuffer& buffer) { glapi::pack::LoadName(buffer, name); });
}

void PushName(Context& c, GLuint name) {
    if (!selecting(c)) return;
    if (c.select->name_depth >= kNameStackLimit) return c.error(GL_STACK_OVERFLOW);
    ++c.select->name_depth;
    send_name(c, [&](wire::PackBuffer& buffer) { glapi::pack::PushName(buffer, name); });
}

void PopName(Context& c) {
    if (!selecting(c)) return;
    if (c.select->name_depth == 0) return c.error(GL_STACK_UNDERFLOW);
    --c.select->name_depth;
    send_name(c, [](wire::PackBuffer& buffer) { glapi::pack::PopName(buffer); });
}

void PassThrough(Context& c, GLfloat token) {
    if (c.state.local.render_mode != GL_FEEDBACK) return;
    send_name(c, [&](wire::PackBuffer& buffer) { glapi::pack::PassThrough(buffer, token); });
}

}  // namespace wall::client::api
