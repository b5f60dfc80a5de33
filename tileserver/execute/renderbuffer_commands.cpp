// SPDX-License-Identifier: MIT
#include "tileserver/execute/renderbuffer_commands.h"

#include <algorithm>

#include "tileserver/objects/renderbuffer.h"

namespace wall::tileserver {

// A driver refuses formats and numbers of samples that no rule here knows of; the renderbuffer is then empty.
void RenderbufferCommands::Renderbuffer(ClientName name, std::uint32_t samples, GLenum internal_format,
                                        std::uint32_t width, std::uint32_t height) {
    constexpr std::uint32_t kMostSamples = 64, kMost = wire::kMaxSurfaceExtent;
    if (samples > kMostSamples || width > kMost || height > kMost) return execution_.refuse("absurd size");
    const auto made = execution_.session.objects.make<tileserver::Renderbuffer>(name, execution_.node.driver);
    if (!made) return execution_.refuse(made.error().message);
    tileserver::Renderbuffer& renderbuffer = **made;
    const bool affordable =
        renderbuffer.affords_samples(std::uint64_t{std::max(samples, 1u)} * std::uint64_t{width} * height);
    if (!affordable || !renderbuffer.define(samples, internal_format, static_cast<std::int32_t>(width),
                                            static_cast<std::int32_t>(height)))
        execution_.refuse("more memory of objects than a session may have");
}

}  // namespace wall::tileserver
