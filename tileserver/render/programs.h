// SPDX-License-Identifier: MIT
// The GLSL programs of one session in the driver: client name -> driver program, client locations -> driver locations.
// Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/glapi/program_format.h"
#include "tileserver/render/driver.h"
#include "tileserver/render/layer.h"

namespace wall::tileserver {

inline constexpr std::size_t kMaxPrograms = 1 << 14;          ///< of a session
inline constexpr std::size_t kMaxProgramLocations = 1 << 18;  ///< elements of all uniforms of a program

class Programs {
public:
    explicit Programs(Driver& driver) : driver_(driver), gl_(driver.gl()) {}
    ~Programs();
    Programs(const Programs&) = delete;

    /// Tries to compile; the encoded CompileResult. An error: no such kind of shader.
    Result<std::vector<std::byte>> compile(GLenum type, std::span<const std::byte> source);
    /// Links and takes the result's place if that works. The encoded ProgramReflection if `reflect`. An error: bad
    /// bytes.
    Result<std::vector<std::byte>> link(ClientName name, std::span<const std::byte> definition, bool reflect);
    void erase(ClientName name);
    Result<void> set_uniform(ClientName name, std::uint32_t location, GLenum type, std::uint32_t count,
                             std::span<const std::byte> values);
    /// The driver draws with it, in this layer. Name 0 or an unknown one: with none.
    void use(ClientName name, const LayerGeometry& layer) { name ? use_named(name, layer) : driver_.use_program(0); }

private:
    struct Program {
        GLuint driver = 0;
        std::vector<GLint> locations;  ///< by the client's location; -1: not active here
        GLint window = -1;             ///< location of kWindowUniform
        bool upper_left = false;
        std::array<float, 4> window_value{};
    };
    struct Built {
        GLuint program = 0;
        bool upper_left = false;
    };
    void use_named(ClientName name, const LayerGeometry& layer);
    Built build(const glapi::ProgramDefinition& definition);
    GLuint build_shader(const glapi::ShaderSource& shader, bool& upper_left);
    std::vector<GLint> map_locations(GLuint program, const std::vector<glapi::UniformName>& names) const;
    glapi::ProgramReflection reflect(GLuint program) const;
    void read_uniforms(GLuint program, glapi::ProgramReflection& out) const;
    void read_attributes(GLuint program, glapi::ProgramReflection& out) const;
    void read_initial(GLuint program, glapi::ActiveUniform& uniform) const;
    GLint element_location(GLuint program, const std::string& name, std::uint32_t element) const;
    void release(Program& program);

    Driver& driver_;
    const Gl& gl_;
    std::unordered_map<ClientName, Program> programs_;
};

}  // namespace wall::tileserver
