// SPDX-License-Identifier: MIT
// What the commands that draw from vertex arrays have in common. The context's thread.
#pragma once

#include "client_lib/context/context.h"
#include "client_lib/context/node_draw.h"

namespace wall::client::api {

/// Whether primitives of that mode can be drawn from arrays now. False, and an error.
bool check_mode(Context& c, GLenum mode);
/// The same of indices, of which there is a number, and instances. False, and an error.
bool check_indices(Context& c, GLenum mode, GLsizei count, GLenum type, GLsizei instances = 1);
/// Draws in whatever way suits, after the checks.
void draw(Context& c, const ArrayDraw& draw);
/// Points each of which has its size of an array (GL_OES_point_size_array), in as many draws as there are runs of one
/// size: nodes have a size for all of a draw. False: nothing is drawn, they are no points or the array is not enabled.
bool draw_by_sizes(Context& c, const ArrayDraw& draw);
/// draw() without a look at that array.
void draw_of_one_size(Context& c, const ArrayDraw& draw);
/// With the context's primitive restart.
void draw_indexed(Context& c, ArrayDraw draw);

}  // namespace wall::client::api
