// SPDX-License-Identifier: MIT
// Group [run]: geometry that is defined once, compiled into lists of the driver, and called by name (RunCall of group
// [draw]). Render thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "tileserver/execute/content_question.h"
#include "tileserver/execute/execution.h"
#include "tileserver/execute/geometry_commands.h"
#include "tileserver/objects/run.h"

namespace wall::tileserver {

class RunCommands {
public:
    /// Executes the run's commands until a list is full, there is no time left, or its end (glapi::DrawingRun::run).
    using Play = std::function<Result<bool>(glapi::DrawingRun&)>;
    /// All outlive it.
    RunCommands(Execution& execution, GeometryCommands& geometry, ContentQuestion& question, Play play)
        : execution_(execution),
          geometry_(geometry),
          block_(geometry.block()),
          question_(question),
          play_(std::move(play)) {}

    void RunDefine(ClientName run, std::uint32_t commands, std::uint32_t operand_bytes,
                   std::span<const std::byte> content);
    void ShareRun(RequestId request, ClientName run, std::span<const std::byte> key);

    /// A run is being defined: go_on() has something left of it.
    bool compiling() const { return compiling_.has_value(); }
    /// The driver's list has as much as a list may have.
    bool list_is_full() const;
    /// To the run's end, or to where there is no time left.
    void go_on();

private:
    struct Compiling {
        ClientName id;
        std::optional<glapi::ContentKey> promised;
        std::shared_ptr<RunContent> run;
        glapi::DrawingRun content;
        std::uint64_t list_start = 0;  ///< OpenBlock::vertices where the list began
    };
    void compile_part();
    void finish_run();
    void keep(ClientName id, std::shared_ptr<const RunContent> content);

    Execution& execution_;
    GeometryCommands& geometry_;
    OpenBlock& block_;
    ContentQuestion& question_;
    Play play_;
    std::optional<std::pair<ClientName, glapi::ContentKey>> promised_;
    std::optional<Compiling> compiling_;
};

}  // namespace wall::tileserver
