// SPDX-License-Identifier: MIT
#include "tileserver/execute/geometry_commands.h"

namespace wall::tileserver {

void GeometryCommands::Material(GLenum face, GLenum pname, float p0, float p1, float p2, float p3) {
    const glstate::Vec4 value = {p0, p1, p2, p3};
    if (pname == GL_SHININESS && !(p0 >= 0 && p0 <= 128)) return execution_.refuse("shininess is not within 0 and 128");
    if (!block_.trail.material(face, pname, value)) return execution_.refuse("no such face or parameter");
    if (block_.draws) gl_.Materialfv(face, pname, value.data());
}

}  // namespace wall::tileserver
