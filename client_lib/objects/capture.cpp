// SPDX-License-Identifier: MIT
#include "client_lib/objects/capture.h"

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

void Capture::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    std::vector<glstate::BufferRange> ranges;
    for (const CapturedPart& part : parts_) ranges.push_back({part.buffer->id.value, part.offset, part.bytes});
    glapi::pack::Capture(buffer, id, mode_, std::as_bytes(std::span(ranges)));
    packed();
}

void Capture::for_each_image(const std::function<void(const Object&)>& use) const {
    for (const CapturedPart& part : parts_) use(*part.buffer);
}

void Capture::note_drawn() {
    for (const CapturedPart& part : parts_) part.buffer->note_drawn();
}

void Capture::for_each_used(const std::function<void(const Object&)>& use) const {
    use(*renderbuffer_);
    use(*framebuffer_);
    for_each_image(use);
    use(*this);
}

}  // namespace wall::client
