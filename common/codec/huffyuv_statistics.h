// SPDX-License-Identifier: MIT
// The choice of a HuffYUV stream's predictor and tables from its first frame. Pure; any thread.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/frame.h"
#include "common/codec/huffyuv.h"

namespace wall::codec::huffyuv {

/// The stream that suits `frame`, whose format the caller has checked. Its tables hold a code for every symbol.
Stream suit(const FrameView& frame, bool alpha, const EncoderOptions& options);

}  // namespace wall::codec::huffyuv
