// SPDX-License-Identifier: MIT
// What a driver does otherwise than OpenGL says, found by trying it out: versions change what names and version numbers
// would tell.
#pragma once

#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

struct Quirks {
    /// A generic attribute and one of fixed function (3 and the colour) lie at one place, as GL_ARB_vertex_program
    /// allows and OpenGL does not: NVIDIA's.
    bool keeps_attributes_together = false;
    /// What a buffer began with is written behind glBufferSubData, once an array lies in it: NVIDIA's 580.159 on an
    /// H200. What the GPU copies is there in its order.
    bool loses_writes = false;
};

/// Leaves behind the generic attribute 3 and the colour as they came. Render thread; the context is current.
Quirks try_out(const Gl& gl);

}  // namespace wall::tileserver
