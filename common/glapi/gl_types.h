// SPDX-License-Identifier: MIT
// OpenGL's types and enumerants, from the headers of libgl-dev. No function of libGL may be called through them: a
// program's entry points are ours, a driver's come from glapi::GlFunctions.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
