// SPDX-License-Identifier: MIT
#include "tileserver/objects/capture.h"

#include <algorithm>
#include <utility>

#include "tileserver/objects/buffer.h"

namespace wall::tileserver {

namespace {

/// Vertices of a single primitive.
std::uint64_t vertices_of(GLenum mode) { return mode == GL_TRIANGLES ? 3 : mode == GL_LINES ? 2 : 1; }

}  // namespace

void Capture::release() {
    if (name_ == 0) return;
    driver_.end_queries();
    driver_.stop_capturing();
    const Gl& gl = driver_.gl();
    gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_);
    gl.EndTransformFeedback();
    gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    gl.DeleteTransformFeedbacks(1, &name_);
    name_ = 0;
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

/// Several streams go to several buffers.
bool Capture::count() {
    std::uint64_t bytes = 0;
    const unsigned streams = parts_.size() > 1 ? kVertexStreams : 1;
    for (unsigned stream = 0; stream < streams; ++stream) {
        counting_[stream] = std::make_shared<const DriverQuery>(driver_, QueryTarget::captured, stream);
        primitives_[stream].add(counting_[stream]);
        bytes += primitives_[stream].bytes();
    }
    return has_content(bytes);
}

bool Capture::go_on(const ObjectTable& objects) {
    if (parts_.empty() || ended_) {
        driver_.discard_all();
        return true;
    }
    if (name_ == 0) {
        begin(objects);
    } else {
        driver_.gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_);
        driver_.gl().ResumeTransformFeedback();
    }
    driver_.captures();
    return count();
}

void Capture::end() {
    release();
    ended_ = true;
    counting_ = {};
}

void Capture::define_ended(const Counts& counts) {
    defined_ = ended_ = counted_ = true;
    counts_ = counts;
}

const Capture::Counts& Capture::counts() {
    if (!std::exchange(counted_, true))
        for (unsigned stream = 0; stream < kVertexStreams; ++stream)
            counts_[stream] = primitives_[stream].result() * vertices_of(mode_);
    return counts_;
}

}  // namespace wall::tileserver
