// SPDX-License-Identifier: MIT
// The OpenGL functions that a moved reference puts in the place of Mesa's: whatever is told or answered in window
// pixels.
#pragma once

#include <string_view>

namespace golden::moved {

using Lookup = void* (*)(const char* name);  ///< of Mesa's own functions

/// Called before the first replacement() with the vendor's lookup.
void use(Lookup mesa);
/// What a program gets for `name` instead of Mesa's function; null: Mesa's.
void* replacement(std::string_view name);
/// The current context has just been bound for the first time: its viewport and scissor are the window's.
void move_new_context();

}  // namespace golden::moved
