// SPDX-License-Identifier: MIT
// An assembly program as the application defined it (GL_ARB_vertex_program, GL_ARB_fragment_program), what one node
// said of its string, and its local parameters, with a stamp each: a node is sent those that changed since it last drew
// with it. Guarded by the share group's mutex.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "client_lib/objects/object.h"
#include "common/glapi/assembly_format.h"

namespace wall::client {

class AssemblyProgram final : public Object {
public:
    AssemblyProgram(GLuint own_name, glapi::AssemblyStage own_stage);

    const glapi::AssemblyStage stage;
    std::vector<ContextId> bound_by;  ///< contexts that ever bound it

    /// It has a string that compiles: it can be drawn with.
    bool loaded() const { return load_stamp_ != 0; }
    const std::string& source() const { return source_; }
    /// Of the string; of a program without one, nothing of anything.
    const glapi::AssemblyReflection& reflection() const { return reflection_; }
    /// Takes a string that compiles, and what a node has said of it.
    void load(std::string source, glapi::AssemblyReflection reflection);

    using Parameter = std::array<float, 4>;
    Parameter local(std::size_t index) const { return index < locals_.size() ? locals_[index] : Parameter{}; }
    /// Whether the parameters from `first` on are these.
    bool holds(std::size_t first, std::span<const Parameter> values) const;
    void set_locals(std::size_t first, std::span<const Parameter> values);

    /// How it places vertices, with its local parameters.
    glapi::LinkedPosition& position() { return position_; }

    std::uint64_t latest() const override { return loaded() ? last_change_ : 0; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;
    std::uint64_t defined() const override { return load_stamp_; }
    void pack_values(std::uint64_t known, wire::PackBuffer& buffer) const override;

private:
    void pack_locals(std::uint64_t known, wire::PackBuffer& buffer) const;

    std::string source_;
    glapi::AssemblyReflection reflection_{};
    std::uint64_t load_stamp_ = 0, last_change_ = 0;
    std::vector<Parameter> locals_;      ///< those behind the last one are 0
    std::vector<std::uint64_t> stamps_;  ///< of the latest change of each; 0: none
    glapi::LinkedPosition position_;
};

}  // namespace wall::client
