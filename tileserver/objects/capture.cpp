// SPDX-License-Identifier: MIT
#include "tileserver/objects/capture.h"

#include <algorithm>
#include <utility>

#include "tileserver/objects/buffer.h"

namespace wall::tileserver {

Capture::~Capture() {
    if (name_ == 0) return;
    driver_.stop_capturing();
    const Gl& gl = driver_.gl();
    gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_);
    gl.EndTransformFeedback();
    gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    gl.DeleteTransformFeedbacks(1, &name_);
}

void Capture::define(GLenum mode, std::vector<glstate::BufferRange> parts) {
    defined_ = true;
    mode_ = mode;
    parts_ = std::move(parts);
}

/// A part that its buffer does not have is left out; the driver refuses to begin then, and nothing is captured.
void Capture::begin(const ObjectTable& objects) {
    const Gl& gl = driver_.gl();
    gl.CreateTransformFeedbacks(1, &name_);
    gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const glstate::BufferRange& part = parts_[i];
        const Buffer* buffer = objects.find<Buffer>(ClientName(part.buffer));
        if (buffer == nullptr || part.offset >= buffer->size() || part.offset % 4 != 0) continue;
        const std::uint64_t rest = buffer->size() - part.offset;
        const std::uint64_t bytes = (part.size != 0 ? std::min<std::uint64_t>(part.size, rest) : rest) / 4 * 4;
        if (bytes != 0)
            gl.TransformFeedbackBufferRange(name_, static_cast<GLuint>(i), buffer->name(), part.offset,
                                            static_cast<GLsizeiptr>(bytes));
    }
    gl.BeginTransformFeedback(mode_);
}

void Capture::go_on(const ObjectTable& objects) {
    if (parts_.empty()) return driver_.discard_all();
    if (name_ == 0) {
        begin(objects);
    } else {
        driver_.gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_);
        driver_.gl().ResumeTransformFeedback();
    }
    driver_.captures();
}

}  // namespace wall::tileserver
