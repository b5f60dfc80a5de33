// SPDX-License-Identifier: MIT
#include "client_lib/context/copied_parts.h"

#include <mutex>

#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/query_state.h"
#include "client_lib/context/scissor_box.h"
#include "common/glstate/draw_buffers.h"

namespace wall::client {

CopyOfParts::CopyOfParts(Context& c, const Corners& from, const Corners& to, GLbitfield mask)
    : c_(c), read_(c.framebuffers->read), draw_(c.framebuffers->draw) {
    if (!c_.draw_target() || c_.draws_nothing || read_ == draw_) {
        want_whole_images(c_);
        return;
    }
    if (draw_ && has_samples()) {
        draw_->note_resolved();
        if (const ImageParts* const parts = draw_->parts(); parts && parts->images_width != 0) want_whole_images(c_);
    }
    const bool as_it_is = from.x0 < from.x1 && from.y0 < from.y1 && to.x1 - to.x0 == from.x1 - from.x0 &&
                          to.y1 - to.y0 == from.y1 - from.y0;
    moved_ = place_of_copy(c_, to.x0 - from.x0, to.y0 - from.y0);
    is_plain_ = as_it_is && (mask & GL_COLOR_BUFFER_BIT) != 0 && takes_all(from) && comes_to_all(to);
    if (!read_->parts() || (is_plain_ && goes_on(c_, *read_, moved_))) return;
    ends_behind_ = as_it_is && draw_ && makes_pixels();
    if (!ends_behind_) want_whole_images(c_);
}

bool CopyOfParts::takes_all(const Corners& from) const {
    const Extent size = c_.read_target().size();
    return from.x0 == 0 && from.y0 == 0 && from.x1 == static_cast<GLint>(size.width) &&
           from.y1 == static_cast<GLint>(size.height);
}

/// Into the back buffer of the window, or over all of another framebuffer object.
bool CopyOfParts::comes_to_all(const Corners& to) const {
    if (!draw_) return draws_to_back_buffer(c_);
    const Extent size = c_.draw_target().size();
    const auto scissor = scissor_box(c_.state);
    const bool cut = scissor && (scissor->x0 > 0 || scissor->y0 > 0 || scissor->x1 < static_cast<float>(size.width) ||
                                 scissor->y1 < static_cast<float>(size.height));
    return !cut && to.x0 == 0 && to.y0 == 0 && to.x1 == static_cast<GLint>(size.width) &&
           to.y1 == static_cast<GLint>(size.height);
}

bool CopyOfParts::has_samples() const {
    std::lock_guard lock(c_.share().mutex);
    return read_->samples() != 0;
}

/// Samples cannot be read, but what is made of them can.
bool CopyOfParts::makes_pixels() const {
    if (!has_samples()) return false;
    std::lock_guard lock(c_.share().mutex);
    return draw_->samples() == 0 && draw_->has_plain_images();
}

void CopyOfParts::finish() {
    if (ends_behind_)
        c_.session().drawn_parts([&](DrawnParts& parts) {
            if (read_->parts() && !draw_->parts()) parts.inherit(draw_, c_.draw_source(), moved_.x, moved_.y);
            parts.end(c_.share());
        });
    if (!is_plain_) return;
    if (draw_) {
        std::lock_guard lock(c_.share().mutex);
        draw_->note_redrawn();
    }
    note_copy(c_, read_, moved_);
}

// ---- any copy ----

namespace {

/// Of what the context draws to. That of an object is the frame in which it was copied last: contexts that draw off the
/// window have no frames of their own.
std::uint32_t frame_of(const Context& c) {
    const auto& draw = c.framebuffers->draw;
    return draw ? draw->copied.frame() : c.read_surface()->frame;
}

}  // namespace

CopiedOut::Place place_of_copy(const Context& c, GLint x, GLint y) {
    const auto& draw = c.framebuffers->draw;
    return {draw ? draw->id : ClientName(), draw ? SurfaceId() : c.read_surface()->id, x, y};
}

bool draws_to_back_buffer(const Context& c) {
    const DrawTarget target = c.draw_target();
    return !c.framebuffers->draw && target.pictured_surface() && target.pictured_surface() == c.read_surface() &&
           target.format().double_buffered && glstate::names_back_only(c.state.window.draw_buffer);
}

bool goes_on(Context& c, DrawnTarget& copied, const CopiedOut::Place& to) {
    if (!copied.parts() || !copied.copied.goes_on(frame_of(c), to)) return false;
    bool enough = false;
    c.session().drawn_parts([&](DrawnParts& parts) { enough = parts.suffice(copied, c.draw_target(), to.x, to.y); });
    return enough;
}

void note_copy(Context& c, const std::shared_ptr<DrawnTarget>& copied, const CopiedOut::Place& to) {
    if (copied->take_ended()) copied->copied.note_broken();
    if (!copied->copied.note(frame_of(c), to) || copied->parts()) return;
    if (c.queries->current(QuerySlot::samples, 0)) return;  // each node would count its own
    {
        std::lock_guard lock(c.share().mutex);
        if (!copied->has_plain_images()) return;
    }
    c.flush_block();  // the copy itself
    c.session().drawn_parts([&](DrawnParts& parts) { parts.begin(copied, c.draw_source(), to.x, to.y); });
}

}  // namespace wall::client
