// SPDX-License-Identifier: MIT
#include "tileserver/execute/renderbuffer_commands.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/glapi/image.h"
#include "common/wire/limits.h"
#include "tileserver/execute/image_check.h"
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
        execution_.refuse(too_much("memory of objects"));
}

void RenderbufferCommands::RenderbufferRead(RequestId request, ClientName name, std::int32_t first_row,
                                            std::int32_t rows, GLenum format, GLenum type) {
    std::vector<std::byte> answer;
    auto* renderbuffer = execution_.session.objects.find<tileserver::Renderbuffer>(name);
    if (renderbuffer != nullptr && renderbuffer->has_rows(first_row, rows)) {
        const auto bytes = glapi::image_bytes(format, type, renderbuffer->width(), rows, 1);
        if (!bytes || *bytes > wire::kMaxFramePayload - 8)
            return execution_.refuse("no such format or type, or too large");
        answer.resize(*bytes);
        renderbuffer->read(first_row, rows, format, type, answer);
    }
    execution_.output.reply(request, std::move(answer));
}

void RenderbufferCommands::RenderbufferWrite(ClientName name, std::int32_t first_row, std::int32_t rows, GLenum format,
                                             GLenum type, std::span<const std::byte> pixels) {
    const auto found = execution_.session.objects.get<tileserver::Renderbuffer>(name);
    if (!found) return execution_.refuse(found.error().message);
    if (!(*found)->has_rows(first_row, rows)) return;  // the driver did not make it
    if (!image_fits(execution_, format, type, {(*found)->width(), rows, 1}, pixels)) return;
    (*found)->write(first_row, rows, format, type, pixels);
}

}  // namespace wall::tileserver
