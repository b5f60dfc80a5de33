// SPDX-License-Identifier: MIT
// Program pipelines (OpenGL 4.1, 2.14.4): programs that are drawn with together, each for some stages. To whoever draws
// it is a program like others, made of its parts; nodes know which programs it has. Belongs to one context; guarded by
// the share group's mutex.
#pragma once

#include <array>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

struct ProgramPipeline final : Program {
    static constexpr std::size_t kStages = std::size(glapi::kShaderStages);

    /// `exact`: what a program takes and what the one before it gives away must be the same (OpenGL ES 3.1, 7.4.1).
    ProgramPipeline(GLuint pipeline_name, bool exact);

    const GLuint pipeline;  ///< its name; as a program it has none
    /// In the order of glapi::kShaderStages; null: none.
    std::array<std::shared_ptr<Program>, kStages> programs;
    std::shared_ptr<Program> active;  ///< whose uniforms glUniform sets

    /// After `programs` or what one of them was linked from has changed.
    void combine();
    /// Why its programs cannot run together (OpenGL 4.5, 11.1.3.11), whatever their samplers name; empty: they can.
    const std::string& fault() const { return fault_; }
    /// Whether one of its programs was linked again since.
    bool is_outdated() const;
    /// Its programs, each once.
    std::vector<std::shared_ptr<Program>> parts() const;

    std::uint64_t latest() const override { return executable->stamp; }
    std::uint64_t defined() const override { return latest(); }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;
    void pack_values(std::uint64_t, wire::PackBuffer&) const override {}

private:
    std::string find_fault() const;

    const bool exact_;
    std::string fault_;
};

/// Those of a context.
struct PipelineUse {
    NameTable<ProgramPipeline> names;
    std::shared_ptr<ProgramPipeline> bound;  ///< null: none
    std::shared_ptr<Program> used;           ///< by glUseProgram, in place of a pipeline; null: none
};

}  // namespace wall::client
