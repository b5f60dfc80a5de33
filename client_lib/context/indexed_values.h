// SPDX-License-Identifier: MIT
// Setting what draw buffers or viewports have each for itself (common/glstate/indexed_values.h). The context's thread.
#pragma once

#include <algorithm>

#include "client_lib/context/context.h"
#include "client_lib/context/limits.h"
#include "common/glstate/draw_buffers.h"
#include "common/glstate/indexed_values.h"

namespace wall::client {

/// How many draw buffers there are.
inline GLuint draw_buffers_of(const Context& c) {
    constexpr auto kMost = static_cast<double>(glstate::kDrawBuffers);
    if (!c.attached()) return glstate::kDrawBuffers;
    return static_cast<GLuint>(std::min(kMost, limit_of(c.caps(), GL_MAX_DRAW_BUFFERS, kMost)));
}

/// How many viewports.
inline GLuint viewports_of(const Context& c) {
    constexpr auto kMost = static_cast<double>(glstate::kViewports);
    if (!c.attached()) return glstate::kViewports;
    return static_cast<GLuint>(std::clamp(limit_of(c.caps(), GL_MAX_VIEWPORTS, 1), 1.0, kMost));
}

/// All of them get `value`.
template <class E, class R>
void set_everywhere(Context& c, const typename E::type& value) {
    c.set<E>(0, value);
    for (unsigned i = 0; i < R::count; ++i) c.set<R>(i, glstate::as_the_first<typename R::type>());
}

/// One of them gets it; there are so many.
template <class E, class R>
void set_at(Context& c, GLuint index, const typename E::type& value) {
    if (index != 0) return c.set<R>(index - 1, value);
    if (glstate::same(c.get<E>(), value)) return;
    for (unsigned i = 0; i < R::count; ++i) c.set<R>(i, glstate::value_at<E, R>(c.state, i + 1));
    c.set<E>(0, value);
}

}  // namespace wall::client
