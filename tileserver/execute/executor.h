// SPDX-License-Identifier: MIT
// Executes one session's stream: the handler of glapi::BatchRun, made of a class for each group of proto/gl/wire.toml.
// State commands change soft contexts; blocks draw (block_execution.h). A command that a correct client cannot send is
// refused, and with it the stream. Render thread.
//
// A batch is executed in slices, so that no stream keeps the driver for as long as it likes. Between two of them others
// draw, so a slice leaves the driver in the middle of nothing: glBegin, a list that is compiled, a query and the
// selection mode are ended and begun anew. glBegin can be ended only between two points, lines, triangles or quads of
// their own; what is in the middle of a strip goes on to its end.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/glapi/decoder.h"
#include "tileserver/execute/array_draw_commands.h"
#include "tileserver/execute/assembly_program_commands.h"
#include "tileserver/execute/blit_commands.h"
#include "tileserver/execute/block_execution.h"
#include "tileserver/execute/buffer_commands.h"
#include "tileserver/execute/capture_commands.h"
#include "tileserver/execute/captured_draw_commands.h"
#include "tileserver/execute/content_question.h"
#include "tileserver/execute/dispatch_commands.h"
#include "tileserver/execute/draw_commands.h"
#include "tileserver/execute/draw_pieces_commands.h"
#include "tileserver/execute/execution.h"
#include "tileserver/execute/format_commands.h"
#include "tileserver/execute/framebuffer_commands.h"
#include "tileserver/execute/geometry_commands.h"
#include "tileserver/execute/image_copy_commands.h"
#include "tileserver/execute/instanced_draw_commands.h"
#include "tileserver/execute/map_commands.h"
#include "tileserver/execute/object_commands.h"
#include "tileserver/execute/partial_commands.h"
#include "tileserver/execute/pipeline_commands.h"
#include "tileserver/execute/program_commands.h"
#include "tileserver/execute/query_commands.h"
#include "tileserver/execute/read_commands.h"
#include "tileserver/execute/renderbuffer_commands.h"
#include "tileserver/execute/run_commands.h"
#include "tileserver/execute/sampler_commands.h"
#include "tileserver/execute/stream_commands.h"
#include "tileserver/execute/surface_commands.h"
#include "tileserver/execute/sync_commands.h"
#include "tileserver/execute/texture_barrier_commands.h"
#include "tileserver/execute/texture_buffer_commands.h"
#include "tileserver/execute/texture_commands.h"
#include "tileserver/execute/texture_drawn_commands.h"
#include "tileserver/execute/vertex_input_commands.h"

namespace wall::tileserver {

class Executor : public glapi::Handler {
    // Before the groups, which refer to them.
    Execution execution_;
    ContentQuestion question_;

public:
    using Clock = Execution::Clock;

    /// All three outlive it.
    Executor(RenderNode& node, SessionReplica& session, SessionOutput& output);

    /// Begins one batch frame's payload, which must stay until it has been executed; nothing of it runs yet.
    Result<void> start_batch(std::span<const std::byte> payload);
    /// Executes about a slice of what is left of it. True: all of it is done. Behind it the driver is in the middle of
    /// nothing, and others may draw.
    Result<bool> run_slice(const Slice& slice);
    /// Commands in the last slice.
    std::uint64_t told() const { return execution_.told; }
    /// The next slice would do nothing: a shader is still on trial, or partial pictures have not come.
    bool waits() const { return program.waits() || partial.waits(); }
    /// Both, to the end.
    Result<void> run_batch(std::span<const std::byte> payload);
    void present(SurfaceId surface_id, std::uint32_t frame) { surface.present(surface_id, frame); }
    /// False: the session waits for content that another one is sending; nothing of it may run.
    Result<bool> pursue_question();

    // ---- the decoder's interface: what takes the commands of each group ----
    static constexpr bool kByGroup = true;
    GeometryCommands geometry{execution_};
    DrawCommands draw{execution_, geometry.block()};
    ArrayDrawCommands array_draw{execution_, geometry.block()};
    InstancedDrawCommands instanced_draw{execution_, array_draw};
    StreamCommands stream{execution_};
    StreamCommands& begin_again = stream;
    SurfaceCommands surface{execution_};
    SurfaceCommands& surface_view = surface;
    ReadCommands read{execution_};
    ObjectCommands object{execution_};
    TextureCommands texture{execution_, question_};
    TextureCommands& texture_view = texture;
    RunCommands run{execution_, geometry, question_, [this](glapi::DrawingRun& r) { return r.run(*this); }};
    ProgramCommands program{execution_};
    ProgramCommands& subroutine = program;
    ProgramCommands& storage = program;
    AssemblyProgramCommands assembly{execution_, program};
    DispatchCommands dispatch{execution_, geometry.block()};
    ImageCopyCommands image_copy{execution_, geometry.block()};
    PipelineCommands pipeline{execution_};
    BufferCommands buffer{execution_};
    CaptureCommands capture{execution_};
    CaptureCommands& capture_end = capture;
    CapturedDrawCommands captured_draw{execution_, array_draw, instanced_draw};
    VertexInputCommands vertex_input{execution_};
    DrawPiecesCommands draw_pieces{execution_};
    RenderbufferCommands renderbuffer{execution_};
    FormatCommands format{execution_};
    FramebufferCommands framebuffer{execution_};
    TextureDrawnCommands texture_drawn{execution_};
    SamplerCommands sampler{execution_};
    TextureBufferCommands texture_buffer{execution_};
    BlitCommands blit{execution_, geometry.block()};
    TextureBarrierCommands texture_barrier{execution_, geometry.block()};
    QueryCommands query{execution_};
    MapCommands map{execution_};
    SyncCommands sync{execution_};
    PartialCommands partial{execution_};
    PartialCommands& piece_range = partial;

    std::uint64_t begin_block(std::uint64_t tiles, std::size_t bytes) { return blocks_.begin(tiles, bytes); }
    void begin_tile(unsigned slot) { blocks_.begin_tile(slot); }
    bool another_pass() { return blocks_.another_pass(); }
    void end_block() { blocks_.end(); }
    glapi::Pause should_pause(std::size_t told);

private:
    Result<bool> go_on();
    void finish_batch();
    /// Between two commands the open glBegin, if there is one, can be ended and begun anew without a difference.
    bool divisible();

    BlockExecution blocks_{execution_, geometry};

    // Of the batch.
    std::optional<glapi::BatchRun> batch_;
    std::size_t batch_commands_ = 0, batch_bytes_ = 0;
    std::uint64_t counted_before_ = 0;  // bytes of state and geometry
    bool paused_ = false, closely_ = false;
};

}  // namespace wall::tileserver
