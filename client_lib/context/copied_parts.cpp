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
    const bool as_it_is = from.x0 < from.x1 && from.y0 < from.y1 && to.x1 - to.x0 == from.x1 - from.x0 &&
                          to.y1 - to.y0 == from.y1 - from.y0;
    moved_ = {draw_ ? draw_->id : ClientName(), draw_ ? SurfaceId() : c_.read_surface()->id, to.x0 - from.x0,
              to.y0 - from.y0};
    is_plain_ = as_it_is && (mask & GL_COLOR_BUFFER_BIT) != 0 && takes_all(from) && comes_to_all(to);
    if (!read_->parts() || goes_on()) return;
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
    const DrawTarget target = c_.draw_target();
    if (!draw_)
        return target.pictured_surface() == c_.read_surface() && target.format().double_buffered &&
               glstate::names_back_only(c_.state.window.draw_buffer);
    const Extent size = target.size();
    const auto scissor = scissor_box(c_.state);
    const bool cut = scissor && (scissor->x0 > 0 || scissor->y0 > 0 || scissor->x1 < static_cast<float>(size.width) ||
                                 scissor->y1 < static_cast<float>(size.height));
    return !cut && to.x0 == 0 && to.y0 == 0 && to.x1 == static_cast<GLint>(size.width) &&
           to.y1 == static_cast<GLint>(size.height);
}

/// Samples cannot be read, but what is made of them can.
bool CopyOfParts::makes_pixels() const {
    std::lock_guard lock(c_.share().mutex);
    return read_->samples() != 0 && draw_->samples() == 0 && draw_->has_plain_images();
}

bool CopyOfParts::goes_on() {
    if (!is_plain_ || !read_->copied.goes_on(c_.read_surface()->frame, moved_)) return false;
    bool enough = false;
    c_.session().drawn_parts(
        [&](DrawnParts& parts) { enough = parts.suffice(*read_, c_.draw_target(), moved_.x, moved_.y); });
    return enough;
}

void CopyOfParts::finish() {
    if (ends_behind_)
        c_.session().drawn_parts([&](DrawnParts& parts) {
            if (read_->parts() && !draw_->parts()) parts.inherit(draw_, c_.draw_source(), moved_.x, moved_.y);
            parts.end(c_.share());
        });
    if (is_plain_) note_habit();
}

void CopyOfParts::note_habit() {
    if (draw_) draw_->copied.note_redrawn();
    if (read_->take_ended()) read_->copied.note_broken();
    if (!read_->copied.note(c_.read_surface()->frame, moved_) || read_->parts()) return;
    if (c_.queries->current(QuerySlot::samples, 0)) return;  // each node would count its own
    {
        std::lock_guard lock(c_.share().mutex);
        if (!read_->has_plain_images()) return;
    }
    c_.session().drawn_parts([&](DrawnParts& parts) { parts.begin(read_, c_.draw_source(), moved_.x, moved_.y); });
}

}  // namespace wall::client
