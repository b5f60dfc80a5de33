// SPDX-License-Identifier: MIT
// Where OpenGL comes from: one driver context (4.5 compatibility), without a window, or with the screens that tiles are
// shown on. One implementation per file (egl_backend.cpp, egl_x11_backend.cpp, osmesa_backend.cpp,
// tileserver/kms/kms_backend.cpp). Created and used by the render thread.
#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace wall::tileserver {

struct WindowRequest;
class TileScreens;

class GlBackend {
public:
    virtual ~GlBackend() = default;
    GlBackend() = default;
    GlBackend(const GlBackend&) = delete;
    GlBackend& operator=(const GlBackend&) = delete;

    /// Makes the context current in the calling thread; it stays so until the backend is destroyed there.
    virtual Result<void> make_current() = 0;
    /// A function of the driver by name, null if it has none.
    virtual void* get_proc_address(const char* name) const = 0;
    virtual std::string_view name() const = 0;
    /// That tiles are shown on; null: all tiles are headless.
    virtual TileScreens* screens() { return nullptr; }
};

inline constexpr std::string_view kAnyGpu = "auto";

/// Which driver, in the words of wall.toml.
struct BackendChoice {
    template <class Name>
    requires std::convertible_to<Name, std::string_view> BackendChoice(
        const Name& backend, std::string_view which = kAnyGpu)  // NOLINT: a name alone is a choice
        : name(std::string_view(backend)), gpu(which) {}
    std::string name;  ///< egl, osmesa
    std::string gpu;   ///< of egl (gpu_devices.h)
};

/// A GPU's EGL device if there is one, else Mesa's surfaceless platform (llvmpipe). `gpu`: as of choose_gpu().
Result<std::unique_ptr<GlBackend>> open_egl_backend(std::string_view gpu = kAnyGpu);
/// Off-screen Mesa, from a library that is looked for now; newer Mesa releases have none.
Result<std::unique_ptr<GlBackend>> open_osmesa_backend();
/// EGL on an X display, with windows there.
Result<std::unique_ptr<GlBackend>> open_window_backend(const WindowRequest& request);
/// Without windows.
Result<std::unique_ptr<GlBackend>> open_backend(const BackendChoice& choice);

}  // namespace wall::tileserver
