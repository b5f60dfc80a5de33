// SPDX-License-Identifier: MIT
#include "client_lib/objects/capture.h"

#include <array>
#include <utility>

#include "gen/glapi/wire.gen.h"

namespace wall::client {

Capture::Capture(GLenum mode, std::vector<CapturedPart> parts)
    : Object(next_object_id()), mode_(mode), parts_(std::move(parts)) {
    renderbuffer_->define(0, GL_RGBA8, 1, 1);
    Attachment color;
    color.renderbuffer = renderbuffer_;
    framebuffer_->attach(0, std::move(color));
}

void Capture::end() {
    ended_ = true;
    stamp_ = next_stamp();
}

/// A node that comes behind the end gets the counts alone; where nothing was drawn, they are 0.
void Capture::pack_changes(std::uint64_t known, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    if (ended_ && known != 0) return glapi::pack::CaptureEnd(buffer, id);
    if (ended_ && drawn_) return;
    if (ended_) {
        const std::array<std::uint64_t, kVertexStreams> nothing{};
        return glapi::pack::CaptureCounted(buffer, id, std::as_bytes(std::span(nothing)));
    }
    std::vector<glstate::BufferRange> ranges;
    for (const CapturedPart& part : parts_)
        ranges.push_back({part.buffer ? part.buffer->id.value : 0, part.offset, part.bytes});
    glapi::pack::Capture(buffer, id, mode_, std::as_bytes(std::span(ranges)));
    packed();
}

void Capture::pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>&) const {
    const auto counts =
        ask([&](wire::PackBuffer& batch, RequestId request) { glapi::pack::CaptureCounts(batch, request, id); }, {});
    const std::array<std::uint64_t, kVertexStreams> nothing{};
    if (counts && counts->size() == sizeof nothing) glapi::pack::CaptureCounted(buffer, id, *counts);
    else glapi::pack::CaptureCounted(buffer, id, std::as_bytes(std::span(nothing)));
}

void Capture::for_each_image(const std::function<void(const Object&)>& use) const {
    for (const CapturedPart& part : parts_)
        if (part.buffer) use(*part.buffer);
}

void Capture::note_drawn() {
    drawn_ = true;
    for (const CapturedPart& part : parts_)
        if (part.buffer) part.buffer->note_drawn();
}

void Capture::for_each_used(const std::function<void(const Object&)>& use) const {
    use(*renderbuffer_);
    use(*framebuffer_);
    for_each_image(use);
    use(*this);
}

}  // namespace wall::client
