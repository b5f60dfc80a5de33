// SPDX-License-Identifier: MIT
// Buffers that the driver's context draws to and a monitor shows: GBM surfaces as EGL's windows. Render thread.
#pragma once

#include <memory>

#include "tileserver/gpu/egl_context.h"
#include "tileserver/kms/drm_device.h"
#include "tileserver/kms/scanout_surface.h"

struct gbm_device;

namespace wall::tileserver {

class GbmSurfaces final : public ScanoutSurfaces {
public:
    /// A context of the card's driver, which is not current yet. `file`: of the open card `device`; both outlive it.
    static Result<std::unique_ptr<GbmSurfaces>> open(DrmDevice& device, int file);
    ~GbmSurfaces() override;

    Result<std::unique_ptr<ScanoutSurface>> make(const Mode& mode) override;
    Result<void> select_none() override;
    void clear(std::uint32_t rgb) override;

private:
    class Surface;
    explicit GbmSurfaces(DrmDevice& device) : device_(device) {}
    Result<void> begin(int file);

    DrmDevice& device_;
    gbm_device* gbm_ = nullptr;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLConfig config_ = nullptr;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace wall::tileserver
