// SPDX-License-Identifier: MIT
// A context as those see it who follow its state.
#include "client_lib/follow/draw_source.h"

#include "client_lib/context/capture_use.h"
#include "client_lib/context/context.h"
#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/gathered_window.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/context/select.h"
#include "client_lib/context/shader_memory.h"
#include "client_lib/context/used_objects.h"
#include "client_lib/process/log.h"

namespace wall::client {
namespace {

/// A layer on each node; none in a context that no session draws for.
const std::vector<TargetLayer>& everywhere(ClientSession* session) {
    static const auto* const nowhere = new std::vector<TargetLayer>;  // never freed: programs draw while they exit
    return session ? session->nodes().everywhere() : *nowhere;
}

}  // namespace

DrawTarget Context::draw_target() const {
    if (!draw_) return {};
    if (memory->now) return DrawTarget(*memory->now, everywhere(session_.get()));
    if (captures->now) return DrawTarget(*captures->now, everywhere(session_.get()));
    if (framebuffers->draw && !select->layer) return DrawTarget(*framebuffers->draw, everywhere(session_.get()));
    return select->layer ? DrawTarget(*draw_, *select->layer) : DrawTarget(*draw_);
}

DrawTarget Context::read_target() const {
    if (!read_) return {};
    return framebuffers->read ? DrawTarget(*framebuffers->read, everywhere(session_.get())) : DrawTarget(*read_);
}

void Context::for_each_used(const std::function<void(const Object&)>& use) { client::for_each_used(*this, use); }

/// All nodes must run all of it, once each; in tiles each would run its own part, and what lies over several twice.
void Context::before_writing_draw() {
    if (!draw_ || framebuffers->draw || select->layer || !writes_memory(*this)) return;
    if (!turn_whole(*this, *draw_))
        complain_once("shaders that write memory draw to a window of a parallel program: what they write may differ",
                      "shader writes");
}

bool Context::writes() { return writes_memory(*this); }

void Context::for_each_written(const std::function<void(const Object&)>& use) { client::for_each_written(*this, use); }

void Context::note_written() { client::note_written(*this); }

DrawSource Context::draw_source() { return {id, state, draw_target(), read_target(), use_stamp(*this), *this, share_}; }

}  // namespace wall::client
