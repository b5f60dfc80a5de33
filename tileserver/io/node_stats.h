// SPDX-License-Identifier: MIT
// The render thread's figures as walld is told them. Pure.
#pragma once

#include "proto/control.pb.h"
#include "tileserver/render/render_thread.h"

namespace wall::tileserver {

/// All that the render thread knows; received bytes and streams are the I/O thread's.
void fill_stats(const RenderStats& stats, proto::NodeStats& out);

}  // namespace wall::tileserver
