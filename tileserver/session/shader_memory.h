// SPDX-License-Identifier: MIT
// The memory that a program's shaders read and write at places that they address: images of textures, blocks of
// storage, atomic counters (OpenGL 4.2 and 4.3). What the driver has bound for a session while it draws is that
// session's own, or nothing. Render thread.
#pragma once

#include "tileserver/objects/pipeline.h"
#include "tileserver/objects/program.h"
#include "tileserver/session/render_node.h"
#include "tileserver/session/session.h"

namespace wall::tileserver {

/// Calls use(program) with the one that a state draws with, or each that its pipeline has.
template <class Use>
void for_each_program(const SessionReplica& session, const glstate::State& state, Use&& use) {
    const ClientName name(glstate::el::current_program::ref(state));
    if (!name) return;
    if (const Program* program = session.objects.find<Program>(name)) use(*program);
    else if (const Pipeline* pipeline = session.objects.find<Pipeline>(name))
        pipeline->for_each_program(session.objects, use);
}

/// Before textures are looked up: those that the state's program may write are not shared with other sessions from now
/// on. False: more memory than a session may have.
[[nodiscard]] bool own_written_textures(RenderNode& node, SessionReplica& session, const glstate::State& state);
/// The driver has bound what a program that is drawn with touches.
void bind_memory(RenderNode& node, const SessionReplica& session, const glstate::State& state, const Program& program);

}  // namespace wall::tileserver
