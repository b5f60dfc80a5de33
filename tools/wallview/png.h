// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/codec/frame.h"

namespace wall::wallview {

/// `picture`: RGBA. Blocks on the disk.
Result<void> save_png(const codec::FrameView& picture, const std::string& path);

}  // namespace wall::wallview
