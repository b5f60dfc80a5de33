// SPDX-License-Identifier: MIT
// What pictures for one monitor are drawn to: two or three buffers in turn, each a framebuffer of the card
// (gbm_surfaces.h is the real one). Render thread.
#pragma once

#include <cstdint>
#include <memory>

#include "common/base/result.h"
#include "tileserver/kms/card.h"

namespace wall::tileserver {

class ScanoutSurface {
public:
    virtual ~ScanoutSurface() = default;
    ScanoutSurface() = default;
    ScanoutSurface(const ScanoutSurface&) = delete;
    ScanoutSurface& operator=(const ScanoutSurface&) = delete;

    /// Makes it the context's default framebuffer.
    virtual Result<void> select() = 0;
    /// What was drawn there is a picture; drawing goes on in another buffer.
    virtual Result<FramebufferId> swap() = 0;
    /// No monitor shows a picture of swap() any more, and it may be drawn over.
    virtual void release(FramebufferId picture) = 0;
};

class ScanoutSurfaces {
public:
    virtual ~ScanoutSurfaces() = default;
    ScanoutSurfaces() = default;
    ScanoutSurfaces(const ScanoutSurfaces&) = delete;
    ScanoutSurfaces& operator=(const ScanoutSurfaces&) = delete;

    /// `mode`: whose size it has. This outlives it.
    virtual Result<std::unique_ptr<ScanoutSurface>> make(const Mode& mode) = 0;
    /// The context is current without a default framebuffer: that which was selected may go.
    virtual Result<void> select_none() = 0;
    /// Fills what is selected, as long as nobody has drawn in the context yet. `rgb`: 0xRRGGBB.
    virtual void clear(std::uint32_t rgb) = 0;
};

}  // namespace wall::tileserver
