// SPDX-License-Identifier: MIT
#include "tileserver/driver/quirks.h"

#include <array>
#include <cstdint>

namespace wall::tileserver {
namespace {

bool keeps_attributes_together(const Gl& gl) {
    constexpr GLuint kPlace = 3;
    constexpr std::array kProbe{0.25f, 0.5f, 0.75f, 1.0f};
    std::array<GLfloat, 4> color{}, attribute{}, seen{};
    gl.GetFloatv(GL_CURRENT_COLOR, color.data());
    gl.GetVertexAttribfv(kPlace, GL_CURRENT_VERTEX_ATTRIB, attribute.data());
    gl.VertexAttrib4fv(kPlace, kProbe.data());
    gl.GetFloatv(GL_CURRENT_COLOR, seen.data());
    gl.VertexAttrib4fv(kPlace, attribute.data());
    gl.Color4fv(color.data());
    return seen == kProbe;
}

bool loses_writes(const Gl& gl) {
    constexpr std::array<std::uint32_t, 6> kWritten{1, 2, 3, 4, 5, 6};
    auto found = decltype(kWritten){};
    GLuint buffer = 0, arrays = 0;
    gl.CreateBuffers(1, &buffer);
    gl.NamedBufferData(buffer, sizeof kWritten, nullptr, GL_STATIC_DRAW);
    gl.ClearNamedBufferData(buffer, GL_R8, GL_RED, GL_UNSIGNED_BYTE, nullptr);
    gl.CreateVertexArrays(1, &arrays);
    gl.VertexArrayVertexBuffer(arrays, 0, buffer, 0, 2 * sizeof(GLfloat));
    gl.NamedBufferSubData(buffer, 0, sizeof kWritten, kWritten.data());
    gl.GetNamedBufferSubData(buffer, 0, sizeof found, found.data());
    gl.DeleteVertexArrays(1, &arrays);
    gl.DeleteBuffers(1, &buffer);
    return found != kWritten;
}

}  // namespace

Quirks try_out(const Gl& gl) { return {keeps_attributes_together(gl), loses_writes(gl)}; }

}  // namespace wall::tileserver
