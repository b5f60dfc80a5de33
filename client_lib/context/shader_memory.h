// SPDX-License-Identifier: MIT
// The objects that the shaders of a context's program read and write at places that they address. The context's thread.
#pragma once

#include <functional>
#include <memory>

#include "client_lib/context/context.h"

namespace wall::client {

/// Whether the context's program may write memory now. The share group's mutex is taken.
bool writes_memory(const Context& c);
/// Calls `use` with the objects that its program may read or write so, and with those that it may write. The share
/// group's mutex is held.
void for_each_touched(const Context& c, const std::function<void(const Object&)>& use);
void for_each_written(const Context& c, const std::function<void(const Object&)>& use);
/// What was written is on the nodes only. The share group's mutex is held.
void note_written(const Context& c);

/// Calls `use` with each buffer that the program's blocks of storage and counters lie in, or that a texture is made of
/// which it has an image of. The share group's mutex is held.
void for_each_touched_buffer(const Context& c, const std::function<void(const std::shared_ptr<Buffer>&)>& use);

/// A texture's name is gone: no image unit of the context has it any more.
void unbind_images(Context& c, ClientName texture);

}  // namespace wall::client
