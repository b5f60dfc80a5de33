// SPDX-License-Identifier: MIT
// glPixelStore's values of a context as common/glapi/image.h takes them.
#pragma once

#include "common/glapi/image.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

glapi::PixelStore unpack_store(const glstate::State& state);
glapi::PixelStore pack_store(const glstate::State& state);

}  // namespace wall::client
