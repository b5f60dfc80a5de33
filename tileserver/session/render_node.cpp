// SPDX-License-Identifier: MIT
#include "tileserver/session/render_node.h"

namespace wall::tileserver {

void finish_frame(RenderNode& node, Work& work, SurfaceReplica& surface, std::uint32_t frame, bool at_once) {
    const bool overtaken = surface.waiting_frame().has_value();
    {
        const Timed timed(work.render);
        if (overtaken) surface.show_frame();
        surface.finish_frame(frame);
        node.driver.gl().Flush();
    }
    ++work.frames;
    if (at_once) surface.show_frame();
    node.driver.forget_target();
    if (overtaken || at_once) ++node.damage;  // else the tiles change when it is presented
}

}  // namespace wall::tileserver
