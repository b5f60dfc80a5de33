// SPDX-License-Identifier: MIT
// A framebuffer object that the program does not know, for work that is done with one on the nodes. The context's
// thread.
#pragma once

#include <memory>

#include "client_lib/context/context.h"
#include "client_lib/objects/framebuffer.h"

namespace wall::client {

/// From bind() on it is the one that is drawn to (GL_DRAW_FRAMEBUFFER) or read from, until this ends.
class OwnFramebuffer {
public:
    OwnFramebuffer(Context& c, GLenum target);
    ~OwnFramebuffer();
    OwnFramebuffer(const OwnFramebuffer&) = delete;
    Framebuffer& operator*() const { return *made_; }
    void bind();

private:
    Context& c_;
    const GLenum target_;
    const std::shared_ptr<Framebuffer> made_ = std::make_shared<Framebuffer>(0), before_;
};

/// While it lives, an element of the state has another value.
template <class E>
class Instead {
public:
    Instead(Context& c, const typename E::type& value, unsigned i = 0) : c_(c), i_(i), before_(c.get<E>(i)) {
        c_.set<E>(i, value);
    }
    ~Instead() { c_.set<E>(i_, before_); }
    Instead(const Instead&) = delete;

private:
    Context& c_;
    const unsigned i_;
    const typename E::type before_;
};

}  // namespace wall::client
