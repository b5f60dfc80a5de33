// SPDX-License-Identifier: MIT
// Groups [program] and [subroutine]: GLSL, and what compilers say of assembly programs. Before the driver of the node
// compiles or links anything it has been tried (compile_trials.h); meanwhile the stream stands at the command, and
// others draw. Render thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/glapi/program_format.h"
#include "tileserver/compile/compile_trials.h"
#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class ProgramCommands {
public:
    /// `execution` outlives it.
    explicit ProgramCommands(Execution& execution) : execution_(execution) {}

    void ShaderCompile(RequestId request, GLenum type, std::span<const std::byte> source);
    void ProgramLink(RequestId request, ClientName program, std::span<const std::byte> definition);
    void UniformBlock(ClientName program, std::uint32_t block, std::uint32_t binding);
    void Uniform(ClientName program, std::uint32_t location, GLenum type, std::uint32_t count,
                 std::span<const std::byte> values);
    void StorageBlock(ClientName program, std::uint32_t block, std::uint32_t binding);
    void Subroutines(ClientName program, GLenum stage, std::span<const std::byte> indices);

    /// Calls `then` once a shader's source, or an assembly program's text, has been tried; not if it was given up.
    void when_tried(GLenum type, std::span<const std::byte> source, std::function<void()> then);

    /// A command of this group is being executed, and nothing behind it may be.
    bool trying() const { return tried_.has_value(); }
    /// What it waits for is not there yet.
    bool waits() const { return tried_ && tried_->trial->outcome() == CompileTrial::Outcome::pending; }
    /// Executes the rest of it, if it can.
    void go_on();

private:
    using Outcome = CompileTrial::Outcome;
    struct Tried {
        std::shared_ptr<const CompileTrial> trial;
        std::function<void(const CompileTrial& trial)> then;
    };
    void hold(std::shared_ptr<const CompileTrial> trial, std::function<void(const CompileTrial& trial)> then);
    /// The answer about one that was given up.
    std::vector<std::byte> given_up_answer(GLenum type);
    void compile(RequestId request, GLenum type, std::span<const std::byte> source);
    /// `recognised`: what is known of the shaders from a trial; null: nothing.
    void link(RequestId request, ClientName program, std::span<const std::byte> definition,
              const glapi::ProgramReflection* recognised = nullptr);
    /// What the program is told of a shader that was given up.
    std::string given_up();

    Execution& execution_;
    std::optional<Tried> tried_;
    int given_up_ = 0;
};

}  // namespace wall::tileserver
