// SPDX-License-Identifier: MIT
// The end of objects: of what a context's draws from arrays made, of textures and renderbuffers whose names are gone.
// What is kept for a hidden part is sent before, and the nodes and the share group know them no more. No mutex is held.
// The context's thread.
#pragma once

#include <memory>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/objects/framebuffer.h"
#include "client_lib/objects/vertex_input.h"

namespace wall::client {

/// Whatever has this name.
void forget(Context& c, ClientName id);
/// What is known of an input's ranges.
void forget_ranges(Context& c, VertexInput& input);
void forget_inputs(Context& c, const std::vector<std::shared_ptr<VertexInput>>& inputs);

/// Its name is gone: it leaves this context's bindings and the framebuffers that are bound, and the nodes, unless
/// another context, a framebuffer or a view has it.
void forget_texture(Context& c, const std::shared_ptr<Texture>& texture);
/// A buffer that no context names any more: it goes with the last use of it if its name is gone. With that the nodes
/// are told.
void forget_unused(Context& c, std::shared_ptr<Buffer> buffer);
/// What is attached, or was, goes if its name is gone and no framebuffer of the context has it.
void forget_orphan(Context& c, const Attachment& attachment);
void forget_orphan(Context& c, const Renderbuffer& renderbuffer);

}  // namespace wall::client
