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
    driver_.gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_);
    end_bound(std::exchange(name_, 0));
}

/// The driver's transform feedback of this name, which is bound. (It cannot be bound again before it is paused.)
void Capture::end_bound(GLuint name) {
    const Gl& gl = driver_.gl();
    gl.EndTransformFeedback();
    gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    gl.DeleteTransformFeedbacks(1, &name);
}

void Capture::define(GLenum mode, std::vector<glstate::BufferRange> parts) {
    defined_ = true;
    mode_ = mode;
    parts_ = std::move(parts);
}

/// One of the driver's, which is left bound. A part that its buffer does not have is left out; the driver refuses to
/// begin then, and nothing is captured.
GLuint Capture::begin(const ObjectTable& objects) {
    const Gl& gl = driver_.gl();
    GLuint name = 0;
    gl.CreateTransformFeedbacks(1, &name);
    gl.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const glstate::BufferRange& part = parts_[i];
        Buffer* buffer = objects.find<Buffer>(ClientName(part.buffer));
        if (buffer == nullptr || part.offset >= buffer->size() || part.offset % 4 != 0) continue;
        buffer->may_be_written();
        const std::uint64_t rest = buffer->size() - part.offset;
        const std::uint64_t bytes = (part.size != 0 ? std::min<std::uint64_t>(part.size, rest) : rest) / 4 * 4;
        if (bytes != 0)
            gl.TransformFeedbackBufferRange(name, static_cast<GLuint>(i), buffer->name(), part.offset,
                                            static_cast<GLsizeiptr>(bytes));
    }
    driver_.begin_capturing(mode_);
    return name;
}

/// Behind one of another mode, one of ours is begun, and ended with nothing drawn: Driver::captured_mode().
void Capture::resume(const ObjectTable& objects) {
    if (driver_.captured_mode() != mode_) end_bound(begin(objects));
    driver_.gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_);
    driver_.gl().ResumeTransformFeedback();
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
    if (name_ == 0) name_ = begin(objects);
    else resume(objects);
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
