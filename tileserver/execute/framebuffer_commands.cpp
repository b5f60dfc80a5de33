// SPDX-License-Identifier: MIT
#include "tileserver/execute/framebuffer_commands.h"

#include "common/glstate/framebuffer.h"
#include "tileserver/objects/texture.h"

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

// A framebuffer that is not there, or no more, has no pixels.
void FramebufferCommands::TargetPart(ClientName name, std::int32_t x, std::int32_t y, std::uint32_t width,
                                     std::uint32_t height, std::uint32_t images_width, std::uint32_t images_height) {
    constexpr std::int32_t kMost = 1 << 24;  // pixels
    if (x < 0 || y < 0 || x > kMost || y > kMost || width > kMost || height > kMost)
        return execution_.refuse("a part that is larger than any image, or outside of it");
    const auto framebuffer = execution_.session.objects.find<tileserver::Framebuffer>(name);
    if (framebuffer == nullptr) return;
    framebuffer->draw_part(geom::Rect{x, y, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)});
    const auto can_be = [](std::uint32_t side) { return side > 0 && side <= std::uint32_t{kMaxImageSide}; };
    if (can_be(images_width) && can_be(images_height))
        framebuffer->enlarge(execution_.session.objects, execution_.node.shared,
                             static_cast<std::int32_t>(images_width), static_cast<std::int32_t>(images_height));
}

void FramebufferCommands::TargetWhole(ClientName name) {
    const auto framebuffer = execution_.session.objects.find<tileserver::Framebuffer>(name);
    if (framebuffer == nullptr) return;
    framebuffer->restore(execution_.session.objects, execution_.node.shared);
    framebuffer->draw_part(std::nullopt);
}

}  // namespace wall::tileserver
