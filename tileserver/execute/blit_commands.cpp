// SPDX-License-Identifier: MIT
#include "tileserver/execute/blit_commands.h"

#include "common/glstate/draw_buffers.h"
#include "tileserver/driver/window_values.h"

namespace wall::tileserver {

// The driver's scissor is that of the target: the block's tile has been entered.
void BlitCommands::Blit(std::int32_t from_x0, std::int32_t from_y0, std::int32_t from_x1, std::int32_t from_y1,
                        std::int32_t to_x0, std::int32_t to_y0, std::int32_t to_x1, std::int32_t to_y1,
                        std::uint32_t mask, GLenum filter) {
    constexpr GLbitfield kBuffers = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    if (block_.in_begin) return execution_.refuse("between Begin and End");
    if ((mask & ~kBuffers) != 0 || (filter != GL_NEAREST && filter != GL_LINEAR))
        return execution_.refuse("no such buffer or filter");
    if (!block_.draws) return;
    const RenderTarget* from = source();
    if (from == nullptr) return;
    const LayerGeometry& g = block_.target->geometry();
    const LayerEdge left = layer_edge(g, to_x0, to_y0), right = layer_edge(g, to_x1, to_y1);
    const LayerGeometry& f = from->geometry();
    const LayerEdge from_left = layer_edge(f, from_x0, from_y0), from_right = layer_edge(f, from_x1, from_y1);
    execution_.gl.BlitNamedFramebuffer(from->framebuffer(), block_.target->framebuffer(), from_left.x, from_left.y,
                                       from_right.x, from_right.y, left.x, left.y, right.x, right.y, mask, filter);
    // Updating may have bound others.
    execution_.node.driver.forget_target();
}

/// The framebuffer that is read from; or the window, if one layer here has all of it. Null: neither is there.
const RenderTarget* BlitCommands::source() {
    const SoftContext& context = *execution_.context;
    if (context.read_framebuffer)
        return execution_.updated(execution_.session.objects.find<tileserver::Framebuffer>(context.read_framebuffer));
    SurfaceReplica* window = execution_.session.surface(context.read);
    const geom::Eye eye = glstate::eye_of(glstate::el::read_buffer::ref(context.state));
    Layer* layer = window != nullptr ? window->whole_layer(eye) : nullptr;
    if (layer == nullptr || !layer->complete()) return nullptr;
    // Its buffer that is read from is chosen where it is bound.
    for (RenderTarget* target : {static_cast<RenderTarget*>(layer), block_.target})
        execution_.node.driver.bind_target(*target, execution_.context->state);
    return layer;
}

}  // namespace wall::tileserver
