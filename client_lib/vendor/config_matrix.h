// SPDX-License-Identifier: MIT
// The framebuffer configurations that both window systems offer: a full matrix, since programs reject one that has
// more than they asked for (a stencil buffer, alpha) as well as less. Pure.
#pragma once

#include <X11/Xutil.h>

#include <cstdint>
#include <vector>

#include "client_lib/context/core.h"

namespace wall::client::vendor {

inline constexpr int kMaxPbufferExtent = 8192;  // pixels a side

/// Samples of a pixel where a configuration has them: so many every driver of OpenGL 3.0 and later has (OpenGL 4.6,
/// table 23.69, MAX_SAMPLES), and the configurations are told before any node is known.
inline constexpr std::uint8_t kWindowSamples = 4;

/// {samples} x {alpha} x {depth} x {stencil} x {double, single} x {accumulation}, the one that most programs want
/// first. Those with samples have no accumulation buffer, as Mesa's. `stereo`: those with buffers for each eye,
/// instead, which have back buffers.
std::vector<SurfaceFormat> format_matrix(bool with_alpha_only, bool with_single_and_accum, bool stereo = false);

/// The X visuals of a screen that can carry 8 bits per channel.
struct ScreenVisuals {
    std::vector<XVisualInfo> opaque;  ///< TrueColor of the default depth, the default visual first
    std::vector<XVisualInfo> argb;    ///< TrueColor, depth 32; at most one
};
ScreenVisuals screen_visuals(Display* display, int screen);

}  // namespace wall::client::vendor
