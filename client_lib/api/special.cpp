// SPDX-License-Identifier: MIT
// Commands about the stream as a whole: clearing, accumulating, flushing, finishing.
#include "client_lib/context/context.h"
#include "client_lib/context/framebuffer_binding.h"

namespace wall::client::api {
namespace {

/// The scissor box limits what a clear touches; without it, everything.
std::optional<PixelRect> clear_box(const Context& c) {
    if (!c.state.window.scissor_enabled) return std::nullopt;
    const auto& box = c.state.window.scissor;
    return PixelRect{static_cast<float>(box.x), static_cast<float>(box.y), static_cast<float>(box.x + box.width),
                     static_cast<float>(box.y + box.height)};
}

/// Nothing of the back buffer is left from before.
bool clears_all(const Context& c, GLbitfield mask) {
    return (mask & GL_COLOR_BUFFER_BIT) != 0 && !c.state.window.scissor_enabled &&
           c.state.window.draw_buffer == GL_BACK && c.state.color_buffer.color_mask == glstate::ColorMask{1, 1, 1, 1};
}

}  // namespace

void Clear(Context& c, GLbitfield mask) {
    constexpr GLbitfield kKnown =
        GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT | GL_ACCUM_BUFFER_BIT;
    if (mask & ~kKnown) return c.error(GL_INVALID_VALUE);
    if (!may_draw_to_target(c)) return;
    if (mask == 0 || c.state.local.render_mode != GL_RENDER) return;
    c.flush_block();
    c.session().hidden_parts([&](HiddenParts& parts) { parts.before_clear(c.draw_source(), mask); });
    c.draw(clear_box(c), needs_of_clear(), [&](wire::PackBuffer& buffer) { glapi::pack::Clear(buffer, mask); });
    if (c.draw_target() && clears_all(c, mask)) c.draw_target().note_cleared();
}

void Accum(Context& c, GLenum op, GLfloat value) {
    if (op < GL_ACCUM || op > GL_ADD) return c.error(GL_INVALID_ENUM);
    if (!may_draw_to_target(c)) return;
    if (!c.draw_target() || c.draw_target().format().accum_bits == 0) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    c.session().hidden_parts([&](HiddenParts& parts) { parts.before_accumulating(c.draw_target()); });
    c.draw(clear_box(c), needs_of_clear(), [&](wire::PackBuffer& buffer) { glapi::pack::Accum(buffer, op, value); });
}

void Flush(Context& c) { c.flush(false); }

// With a double-buffered surface nobody can see before the swap whether the nodes have finished, so glFinish only
// sends (116 of 146 screensaver hacks call it in every frame). What a single-buffered program has drawn is on show
// when glFinish returns.
void Finish(Context& c) { c.flush(c.draw_target() && c.draw_target().shows_at_once()); }

}  // namespace wall::client::api
