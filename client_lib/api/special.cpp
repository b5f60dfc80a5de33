// SPDX-License-Identifier: MIT
// Commands about the stream as a whole: accumulating, flushing, finishing.
#include <mutex>

#include "client_lib/context/context.h"
#include "client_lib/context/fence_object.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/query_state.h"
#include "client_lib/context/scissor_box.h"

namespace wall::client::api {

void Accum(Context& c, GLenum op, GLfloat value) {
    if (op < GL_ACCUM || op > GL_ADD) return c.error(GL_INVALID_ENUM);
    if (!may_draw_to_target(c)) return;
    if (!c.draw_target() || c.draw_target().format().accum_bits == 0) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    c.session().hidden_parts([&](HiddenParts& parts) { parts.before_accumulating(c.draw_target()); });
    c.draw(scissor_box(c.state), needs_of_clear(),
           [&](wire::PackBuffer& buffer) { glapi::pack::Accum(buffer, op, value); });
}

void Flush(Context& c) { c.flush(false); }

// With a double-buffered surface nobody can see before the swap whether the nodes have finished, so glFinish only
// sends (116 of 146 screensaver hacks call it in every frame). What a single-buffered program has drawn is on show
// when glFinish returns. Fences and queries are as if it had waited.
void Finish(Context& c) {
    c.flush(c.draw_target() && c.draw_target().shows_at_once());
    c.queries->reached = c.queries->ended;
    std::lock_guard lock(c.share().mutex);
    for (const auto& [handle, fence] : c.share().fences) fence->signaled = true;
}

}  // namespace wall::client::api
