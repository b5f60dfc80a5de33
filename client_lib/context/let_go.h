// SPDX-License-Identifier: MIT
// The end of what a context has for itself beside buffers: what was captured, and program pipelines. The nodes and the
// share group know it no more. No mutex is held. The context's thread.
#pragma once

#include "client_lib/context/capture_use.h"
#include "client_lib/context/context.h"
#include "client_lib/objects/program_pipeline.h"

namespace wall::client {

/// What is known of the latest capture behind its end.
void forget_ended(Context& c, FeedbackObject& object);
/// Its programs have one user less.
void forget_pipeline(Context& c, ProgramPipeline& pipeline);
/// Of a context that ends: all of it, while it draws with no program any more.
void let_go_of_own_objects(Context& c);

}  // namespace wall::client
