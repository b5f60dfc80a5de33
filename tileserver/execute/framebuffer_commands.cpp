// SPDX-License-Identifier: MIT
#include "tileserver/execute/framebuffer_commands.h"

#include "common/glstate/framebuffer.h"

namespace wall::tileserver {

void FramebufferCommands::Framebuffer(ClientName name, std::span<const std::byte> bytes) {
    const auto definition = glstate::decode_framebuffer(bytes);
    if (!definition) return execution_.refuse("no definition of a framebuffer");
    const auto framebuffer = execution_.session.objects.make<tileserver::Framebuffer>(name, execution_.node.driver);
    if (!framebuffer) return execution_.refuse(framebuffer.error().message);
    (*framebuffer)->define(*definition);
}

void FramebufferCommands::BindTargets(ClientName draw, ClientName read, std::uint32_t counts) {
    execution_.context->draw_framebuffer = draw;
    execution_.context->read_framebuffer = read;
    execution_.context->counts_samples = counts != 0;
    execution_.targets_known = false;
}

}  // namespace wall::tileserver
