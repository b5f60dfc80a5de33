// SPDX-License-Identifier: MIT
#include "tileserver/execute/sampler_commands.h"

#include <array>
#include <bit>

#include "tileserver/objects/sampler.h"

namespace wall::tileserver {

// Parameters and values that the driver does not know it refuses by itself, and nothing changes.
void SamplerCommands::SamplerParameter(ClientName name, GLenum pname, GLenum type, std::uint32_t v0, std::uint32_t v1,
                                       std::uint32_t v2, std::uint32_t v3) {
    const bool color = pname == GL_TEXTURE_BORDER_COLOR;
    if (type != GL_FLOAT && !(color && (type == GL_INT || type == GL_UNSIGNED_INT)))
        return execution_.refuse("no value of that type");
    const auto made = execution_.session.objects.make<Sampler>(name, execution_.node.driver);
    if (!made) return execution_.refuse(made.error().message);
    const GLuint sampler = (*made)->name();
    const std::array bits = {v0, v1, v2, v3};
    if (type == GL_UNSIGNED_INT) return execution_.gl.SamplerParameterIuiv(sampler, pname, bits.data());
    if (type == GL_INT) {
        const auto whole = std::bit_cast<std::array<GLint, 4>>(bits);
        return execution_.gl.SamplerParameterIiv(sampler, pname, whole.data());
    }
    const auto real = std::bit_cast<std::array<GLfloat, 4>>(bits);
    execution_.gl.SamplerParameterfv(sampler, pname, real.data());
}

}  // namespace wall::tileserver
