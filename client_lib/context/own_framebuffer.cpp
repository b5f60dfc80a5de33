// SPDX-License-Identifier: MIT
#include "client_lib/context/own_framebuffer.h"

#include <mutex>

#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

OwnFramebuffer::OwnFramebuffer(Context& c, GLenum target)
    : c_(c), target_(target), before_(*framebuffer_binding(c, target)) {
    std::lock_guard lock(c_.share().mutex);
    c_.share().by_id[made_->id] = made_;
}

void OwnFramebuffer::bind() { bind_framebuffer(c_, target_, made_); }

OwnFramebuffer::~OwnFramebuffer() {
    bind_framebuffer(c_, target_, before_);
    c_.forget_object(made_->id);
    std::lock_guard lock(c_.share().mutex);
    c_.share().by_id.erase(made_->id);
}

}  // namespace wall::client
