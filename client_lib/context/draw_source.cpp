// SPDX-License-Identifier: MIT
// A context as those see it who follow its state.
#include "client_lib/follow/draw_source.h"

#include "client_lib/context/capture_use.h"
#include "client_lib/context/context.h"
#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/select.h"
#include "client_lib/context/used_objects.h"

namespace wall::client {

DrawTarget Context::draw_target() const {
    if (!draw_) return {};
    if (captures->now) return DrawTarget(*captures->now, session_->nodes().everywhere());
    if (framebuffers->draw && !select->layer) return DrawTarget(*framebuffers->draw, session_->nodes().everywhere());
    return select->layer ? DrawTarget(*draw_, *select->layer) : DrawTarget(*draw_);
}

DrawTarget Context::read_target() const {
    if (!read_) return {};
    return framebuffers->read ? DrawTarget(*framebuffers->read, session_->nodes().everywhere()) : DrawTarget(*read_);
}

void Context::for_each_used(const std::function<void(const Object&)>& use) { client::for_each_used(*this, use); }

DrawSource Context::draw_source() { return {id, state, draw_target(), read_target(), use_stamp(*this), *this, share_}; }

}  // namespace wall::client
