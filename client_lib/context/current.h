// SPDX-License-Identifier: MIT
// The calling thread's context and geometry packer. Both live in static TLS (initial-exec), so that reading one is a
// single instruction in the hottest entry points; the space is within what the C library keeps for dlopened objects.
#pragma once

namespace wall::client {

class Context;
class Packer;

#define WALL_TLS __attribute__((tls_model("initial-exec")))

extern constinit thread_local Context* tls_context WALL_TLS;  ///< null: no context is current in this thread
extern constinit thread_local Packer* tls_packer WALL_TLS;  ///< never null: a closed packer when no context is current

/// The calling thread's commands do nothing from now on, as if no context were current.
void go_dark();

}  // namespace wall::client
