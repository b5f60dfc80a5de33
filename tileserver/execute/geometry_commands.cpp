// SPDX-License-Identifier: MIT
#include "tileserver/execute/geometry_commands.h"

namespace wall::tileserver {

/// Mesa 22.3 keeps vertices behind a Begin that it has refused, and then leaves out what the next one draws who uses
/// the driver. So each mode is tried out once with a tile's state, which a client that looks after its program's errors
/// has no use for. A draw of nothing asks for the same as Begin; Begin and End of nothing would do so, too, but Mesa
/// cuts what is drawn behind it into other triangles.
bool GeometryCommands::may_begin() {
    const std::uint32_t bit = 1u << block_.begin.mode;
    if ((block_.undrawable & bit) != 0) return false;
    Driver& driver = execution_.node.driver;
    execution_.session.work.gl_errors += driver.drain_errors();
    gl_.DrawArraysInstanced(block_.begin.mode, 0, 0, 1);
    const unsigned errors = driver.drain_errors();
    execution_.session.work.gl_errors += errors;
    (errors == 0 ? block_.drawable : block_.undrawable) |= bit;
    return errors == 0;
}

void GeometryCommands::Material(GLenum face, GLenum pname, float p0, float p1, float p2, float p3) {
    const glstate::Vec4 value = {p0, p1, p2, p3};
    if (pname == GL_SHININESS && !(p0 >= 0 && p0 <= 128)) return execution_.refuse("shininess is not within 0 and 128");
    if (!block_.trail.material(face, pname, value)) return execution_.refuse("no such face or parameter");
    if (block_.draws) gl_.Materialfv(face, pname, value.data());
}

}  // namespace wall::tileserver
