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
/// With the context's primitive restart.
void draw_indexed(Context& c, ArrayDraw draw);

}  // namespace wall::client::api
