// SPDX-License-Identifier: MIT
#include "client_lib/context/memory_use.h"

#include <utility>

namespace wall::client {

DispatchTarget::DispatchTarget() {
    renderbuffer_->define(0, GL_RGBA8, 1, 1);
    Attachment color;
    color.renderbuffer = renderbuffer_;
    framebuffer_->attach(0, std::move(color));
}

void DispatchTarget::for_each_used(const std::function<void(const Object&)>& use) const {
    use(*renderbuffer_);
    use(*framebuffer_);
}

}  // namespace wall::client
