// SPDX-License-Identifier: MIT
// Which objects a context draws with, as its state is now. A new kind of object is a line in for_each_used().
#pragma once

#include <functional>

#include "client_lib/objects/object.h"

namespace wall::client {

class Context;

/// Calls `use` with each of them, in an order in which a node can get them; one that is used in two ways comes twice.
/// The session's mutex is held, the share group's is taken.
void for_each_used(Context& context, const std::function<void(const Object&)>& use);
UseStamp use_stamp(const Context& context);

}  // namespace wall::client
