// SPDX-License-Identifier: MIT
// The accumulation buffer. Framebuffer objects have none, so it is kept in memory with the arithmetic that Mesa uses
// for its own (signed 16-bit components, main/accum.c's rounding), so that pictures are the same. Render thread.
#pragma once

#include <array>

#include "common/glstate/values.h"
#include "tileserver/driver/driver.h"
#include "tileserver/driver/layer.h"

namespace wall::tileserver {

/// The part of a layer that an operation touches: all of it, or the scissor's part. Layer pixels, y up.
WindowValues::IntBox accum_area(const Layer& layer, const glstate::State& state);

void clear_accum(Layer& layer, const WindowValues::IntBox& area, const glstate::Vec4& value);
/// The layer is bound. `op` is one of glAccum's.
void accumulate(Driver& driver, Layer& layer, const glstate::State& state, GLenum op, float value);

}  // namespace wall::tileserver
