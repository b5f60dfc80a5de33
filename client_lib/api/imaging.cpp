// SPDX-License-Identifier: MIT
// The imaging subset (GL_ARB_imaging), which is not offered: Mesa took it out. Its commands are errors there, as they
// are here; these five are a part of OpenGL 4.5 in compatibility contexts.
#include "client_lib/context/context.h"
#include "gen/client_lib/api.gen.h"

namespace wall::client::api {

void GetnColorTable(Context& c, GLenum, GLenum, GLenum, GLsizei, void*) { c.error(GL_INVALID_OPERATION); }
void GetnConvolutionFilter(Context& c, GLenum, GLenum, GLenum, GLsizei, void*) { c.error(GL_INVALID_OPERATION); }
void GetnHistogram(Context& c, GLenum, GLboolean, GLenum, GLenum, GLsizei, void*) { c.error(GL_INVALID_OPERATION); }
void GetnMinmax(Context& c, GLenum, GLboolean, GLenum, GLenum, GLsizei, void*) { c.error(GL_INVALID_OPERATION); }
void GetnSeparableFilter(Context& c, GLenum, GLenum, GLenum, GLsizei, void*, GLsizei, void*, void*) {
    c.error(GL_INVALID_OPERATION);
}

}  // namespace wall::client::api
