// SPDX-License-Identifier: MIT
// Reading buffers that transform feedback has written to. The context's thread.
#pragma once

#include "client_lib/context/context.h"

namespace wall::client {

/// What only the nodes have of a buffer, because it was captured, comes to the client: before its content is read here.
/// `function`: for what. No mutex is held.
void fetch_captured(Context& c, const std::shared_ptr<Buffer>& buffer, const char* function);
/// The same of one that the context names by its id; nothing of another.
void fetch_captured(Context& c, ClientName id, const char* function);

}  // namespace wall::client
