// SPDX-License-Identifier: MIT
#include "common/glstate/framebuffer.h"

#include <algorithm>
#include <bitset>
#include <cstring>

#include "common/glapi/texture_target.h"
#include "common/wire/operand_reader.h"

namespace wall::glstate {
namespace {

constexpr std::int32_t kMostLevels = 16, kMostLayers = 1 << 14;

bool names_color(GLenum buffer) {
    return buffer == GL_NONE || (buffer >= GL_COLOR_ATTACHMENT0 && buffer < GL_COLOR_ATTACHMENT0 + kColorAttachments);
}

bool plausible(const FramebufferAttachment& attachment, std::bitset<kAttachmentPoints>& taken) {
    const auto place = attachment_place(attachment.point);
    if (!place || taken[*place] || !attachment.object) return false;
    taken.set(*place);
    if (attachment.target == GL_RENDERBUFFER) return attachment.level == 0 && attachment.layer == 0;
    const auto word = glapi::find_target_word(attachment.target);
    if (!word || word->is_proxy() || glapi::dimensions_of(*word->info) == 0 || attachment.level < 0 ||
        attachment.level >= kMostLevels)
        return false;
    if (attachment.layer == kAllLayers) return word->is_object();
    return word->has_images() && attachment.layer >= 0 && attachment.layer < kMostLayers;
}

bool plausible(const FramebufferDefaults& defaults) {
    return defaults.width <= kMostDefaultSize && defaults.height <= kMostDefaultSize &&
           defaults.layers <= kMostDefaultLayers && defaults.samples <= kMostDefaultSamples &&
           defaults.fixed_places <= 1;
}

constexpr std::size_t kDefaultWords = sizeof(FramebufferDefaults) / sizeof(std::uint32_t);

}  // namespace

std::optional<unsigned> attachment_place(GLenum point) {
    if (point == GL_DEPTH_ATTACHMENT) return kColorAttachments;
    if (point == GL_STENCIL_ATTACHMENT) return kColorAttachments + 1;
    if (point == GL_NONE || !names_color(point)) return std::nullopt;
    return point - GL_COLOR_ATTACHMENT0;
}

GLenum attachment_point(unsigned place) {
    if (place < kColorAttachments) return GL_COLOR_ATTACHMENT0 + place;
    return place == kColorAttachments ? GL_DEPTH_ATTACHMENT : GL_STENCIL_ATTACHMENT;
}

std::vector<std::byte> encode(const FramebufferDefinition& definition) {
    const std::size_t attachments = definition.attachments.size() * sizeof(FramebufferAttachment);
    std::array<std::uint32_t, kColorAttachments + 2 + kDefaultWords> head{};
    std::ranges::copy(definition.draw_buffers, head.begin());
    head[kColorAttachments] = definition.read_buffer;
    std::memcpy(&head[kColorAttachments + 1], &definition.defaults, sizeof definition.defaults);
    head.back() = static_cast<std::uint32_t>(definition.attachments.size());
    std::vector<std::byte> out(sizeof head + attachments);
    std::memcpy(out.data(), head.data(), sizeof head);
    if (attachments != 0) std::memcpy(out.data() + sizeof head, definition.attachments.data(), attachments);
    return out;
}

std::optional<FramebufferDefinition> decode_framebuffer(std::span<const std::byte> bytes) {
    wire::OperandReader in(bytes);
    FramebufferDefinition out;
    for (GLenum& buffer : out.draw_buffers) buffer = in.get<std::uint32_t>();
    out.read_buffer = in.get<std::uint32_t>();
    FramebufferDefaults& defaults = out.defaults;
    for (std::uint32_t* word :
         {&defaults.width, &defaults.height, &defaults.layers, &defaults.samples, &defaults.fixed_places})
        *word = in.get<std::uint32_t>();
    const std::size_t count = in.get<std::uint32_t>();
    if (!in.ok() || !plausible(defaults) || !std::ranges::all_of(out.draw_buffers, names_color) ||
        !names_color(out.read_buffer) || count > kAttachmentPoints ||
        in.remaining() != count * sizeof(FramebufferAttachment))
        return std::nullopt;
    std::bitset<kAttachmentPoints> taken;
    for (std::size_t i = 0; i < count; ++i) {
        out.attachments.push_back(wire::load<FramebufferAttachment>(in.raw(sizeof(FramebufferAttachment)).data()));
        if (!plausible(out.attachments.back(), taken)) return std::nullopt;
    }
    return out;
}

}  // namespace wall::glstate
