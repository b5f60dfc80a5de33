// SPDX-License-Identifier: MIT
// GL_WALLGL_views: what a program may know of tiles that look elsewhere (docs/walls.md, "Views").
#include <algorithm>

#include "client_lib/context/context.h"

namespace wall::client::api {

GLsizei GetViewsWALLGL(Context& c, GLsizei count, GLfloat* views) {
    if (count < 0) return c.error(GL_INVALID_VALUE), 0;
    const auto all = c.session().views_of(c.draw_target());
    for (std::size_t i = 0; i < std::min<std::size_t>(all.size(), static_cast<std::size_t>(count)); ++i)
        views = std::ranges::copy(geom::values_of(all[i]), views).out;
    return static_cast<GLsizei>(all.size());
}

}  // namespace wall::client::api
