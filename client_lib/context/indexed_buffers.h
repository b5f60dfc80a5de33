// SPDX-License-Identifier: MIT
// Buffers at indexed targets (OpenGL 3.0, 2.9.1): the parts that blocks of uniforms take their values from, and those
// that transform feedback writes to. The context's thread.
#pragma once

#include "client_lib/context/context.h"

namespace wall::client {

/// Calls `use` with each buffer that the context's program reads: its blocks take their uniforms from it, or a texture
/// that it samples is made of it. The share group's mutex is held.
void for_each_read_buffer(const Context& c, const std::function<void(const std::shared_ptr<Buffer>&)>& use);
/// Stamp of the latest change of any of them; 0: there are none. The share group's mutex is taken.
std::uint64_t latest_of_read_buffers(const Context& c);

/// Before the context draws: what the program has written into persistent mappings of them is a change.
void find_written_to_read(Context& c);
/// Whether what is packed was drawn with it.
bool is_read_buffer(const Context& c, ClientName id);

/// The context has deleted its name.
void unbind_indexed(Context& c, ClientName id);

}  // namespace wall::client
