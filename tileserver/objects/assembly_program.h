// SPDX-License-Identifier: MIT
// An assembly program of a session in the driver (GL_ARB_vertex_program, GL_ARB_fragment_program), with its local
// parameters. Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/result.h"
#include "common/glapi/assembly_format.h"
#include "common/glstate/projection.h"
#include "tileserver/driver/driver.h"
#include "tileserver/driver/render_target.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class AssemblyProgram final : public ObjectOf<ObjectKind::assembly_program> {
public:
    /// One without a string.
    AssemblyProgram(ObjectAccount& account, Driver& driver, glapi::AssemblyStage stage);
    ~AssemblyProgram() override;

    glapi::AssemblyStage stage() const { return stage_; }
    /// Takes the string of an encoded AssemblyDefinition, if the driver does. An error: bad bytes, or more memory than
    /// a session may have.
    Result<void> define(std::span<const std::byte> definition);
    /// From one on; four floats each. An error: there are no such ones, or half of one.
    Result<void> set_locals(std::uint32_t first, std::span<const std::byte> values);
    /// The driver draws with it, in this layer; without one if it has no string.
    void use(const LayerGeometry& layer);
    /// How it places its vertices; nothing: that is not known.
    std::optional<glstate::Projection> project(const glstate::Projection& fixed_function, const glstate::State& state);
    /// The generic vertex attributes that it reads, a bit each.
    std::uint32_t attributes() const { return attributes_; }

private:
    void follow_position(glapi::PositionProgram position);

    Driver& driver_;
    const glapi::AssemblyStage stage_;
    GLuint name_ = 0;      // the driver's
    bool loaded_ = false;  // it has a string
    std::uint32_t attributes_ = 0;
    bool reads_window_ = false, upper_left_ = false, whole_centers_ = false;
    bool invariant_ = false;
    glapi::LinkedPosition position_;
    std::vector<std::array<std::uint32_t, 4>> locals_;  // as the session has set them
};

}  // namespace wall::tileserver
