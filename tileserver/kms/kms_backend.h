// SPDX-License-Identifier: MIT
// The EGL backend of a node with tiles on monitors without a window system. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "tileserver/gpu/backend.h"
#include "tileserver/kms/libdrm_device.h"
#include "tileserver/kms/screen_plan.h"

namespace wall::tileserver {

struct MonitorRequest {
    std::string gpu = std::string(kAnyGpu);  ///< the card's PCI address; "auto": the first that can show the tiles
    std::uint32_t background = 0;            ///< 0xRRGGBB, until a tile is drawn
    std::vector<MonitorWish> wishes{};
};

/// The monitors show the background then, and the context is current. The error says what each card lacks.
Result<std::unique_ptr<GlBackend>> open_kms_backend(const MonitorRequest& request);
/// On this card.
Result<std::unique_ptr<GlBackend>> open_kms_backend(std::unique_ptr<LibdrmDevice> card, const MonitorRequest& request);

}  // namespace wall::tileserver
