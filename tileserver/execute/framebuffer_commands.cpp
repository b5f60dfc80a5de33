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

void FramebufferCommands::TargetPart(ClientName name, std::int32_t x, std::int32_t y, std::uint32_t width,
                                     std::uint32_t height) {
    constexpr std::int32_t kMost = 1 << 24;  // pixels
    if (x < 0 || y < 0 || x > kMost || y > kMost || width > kMost || height > kMost)
        return execution_.refuse("a part that is larger than any image, or outside of it");
    draw_part(name, geom::Rect{x, y, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)});
}

void FramebufferCommands::TargetWhole(ClientName name) { draw_part(name, std::nullopt); }

/// One that is not there, or no more, has no pixels.
void FramebufferCommands::draw_part(ClientName name, const std::optional<geom::Rect>& part) {
    if (const auto framebuffer = execution_.session.objects.find<tileserver::Framebuffer>(name))
        framebuffer->draw_part(part);
}

}  // namespace wall::tileserver
