// SPDX-License-Identifier: MIT
#include "tileserver/kms/gbm_surfaces.h"

#include <gbm.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include "tileserver/gpu/gl.h"

namespace wall::tileserver {
namespace {

constexpr std::uint32_t kPixels = GBM_FORMAT_XRGB8888;
constexpr EGLint kMaxConfigs = 512;

/// Windows of exactly these pixels. Null: there is none.
EGLConfig find_config(EGLDisplay display) {
    constexpr std::array kWanted = {EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    std::array<EGLConfig, kMaxConfigs> configs{};
    EGLint count = 0;
    if (eglChooseConfig(display, kWanted.data(), configs.data(), kMaxConfigs, &count) == EGL_FALSE) return nullptr;
    for (const EGLConfig config : std::span(configs).first(static_cast<std::size_t>(count))) {
        EGLint format = 0, samples = 0;
        eglGetConfigAttrib(display, config, EGL_NATIVE_VISUAL_ID, &format);
        eglGetConfigAttrib(display, config, EGL_SAMPLES, &samples);
        if (format == static_cast<EGLint>(kPixels) && samples == 0) return config;
    }
    return nullptr;
}

BufferLayout layout_of(gbm_bo* buffer) {
    BufferLayout out;
    out.width = gbm_bo_get_width(buffer);
    out.height = gbm_bo_get_height(buffer);
    out.format = gbm_bo_get_format(buffer);
    out.order = gbm_bo_get_modifier(buffer);
    const int parts = std::clamp(gbm_bo_get_plane_count(buffer), 1, static_cast<int>(BufferLayout::kMostParts));
    out.parts = static_cast<std::size_t>(parts);
    for (int part = 0; part < parts; ++part) {
        out.handles[static_cast<std::size_t>(part)] = gbm_bo_get_handle_for_plane(buffer, part).u32;
        out.pitches[static_cast<std::size_t>(part)] = gbm_bo_get_stride_for_plane(buffer, part);
        out.offsets[static_cast<std::size_t>(part)] = gbm_bo_get_offset(buffer, part);
    }
    return out;
}

/// A buffer's framebuffer, which is the buffer's as long as that lives.
struct Attached {
    DrmDevice& device;
    FramebufferId framebuffer;
};

Result<FramebufferId> framebuffer_of(gbm_bo* buffer, DrmDevice& device) {
    if (const auto* attached = static_cast<Attached*>(gbm_bo_get_user_data(buffer))) return attached->framebuffer;
    const auto added = device.add_framebuffer(layout_of(buffer));
    if (added)
        gbm_bo_set_user_data(buffer, new Attached{device, *added}, [](gbm_bo*, void* data) {
            const std::unique_ptr<Attached> attached(static_cast<Attached*>(data));
            attached->device.remove_framebuffer(attached->framebuffer);
        });
    return added;
}

}  // namespace

class GbmSurfaces::Surface final : public ScanoutSurface {
public:
    explicit Surface(GbmSurfaces& all) : all_(all) {}
    ~Surface() override {
        for (const auto& [framebuffer, buffer] : locked_) gbm_surface_release_buffer(gbm_, buffer);
        if (egl_ != EGL_NO_SURFACE) eglDestroySurface(all_.display_, egl_);
        if (gbm_ != nullptr) gbm_surface_destroy(gbm_);
    }
    Result<void> open(const Mode& mode) {
        gbm_ = gbm_surface_create(all_.gbm_, static_cast<std::uint32_t>(mode.width),
                                  static_cast<std::uint32_t>(mode.height), kPixels,
                                  GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING);
        if (gbm_ == nullptr) return fail(all_.device_.name() + " has no buffers for " + text_of(mode));
        egl_ = eglCreatePlatformWindowSurface(all_.display_, all_.config_, gbm_, nullptr);
        if (egl_ == EGL_NO_SURFACE) return fail(egl_error("eglCreatePlatformWindowSurface"));
        return {};
    }
    Result<void> select() override {
        if (eglMakeCurrent(all_.display_, egl_, egl_, all_.context_) == EGL_FALSE)
            return fail(egl_error("eglMakeCurrent"));
        return {};
    }
    Result<FramebufferId> swap() override {
        if (eglSwapBuffers(all_.display_, egl_) == EGL_FALSE) return fail(egl_error("eglSwapBuffers"));
        gbm_bo* buffer = gbm_surface_lock_front_buffer(gbm_);
        if (buffer == nullptr) return fail(all_.device_.name() + " gives no picture to show");
        auto framebuffer = framebuffer_of(buffer, all_.device_);
        if (framebuffer) locked_[*framebuffer] = buffer;
        else gbm_surface_release_buffer(gbm_, buffer);
        return framebuffer;
    }
    void release(FramebufferId picture) override {
        const auto found = locked_.find(picture);
        if (found == locked_.end()) return;
        gbm_surface_release_buffer(gbm_, found->second);
        locked_.erase(found);
    }

private:
    GbmSurfaces& all_;
    gbm_surface* gbm_ = nullptr;
    EGLSurface egl_ = EGL_NO_SURFACE;
    std::map<FramebufferId, gbm_bo*> locked_;  // waiting, in flight or in sight
};

Result<std::unique_ptr<GbmSurfaces>> GbmSurfaces::open(DrmDevice& device, int file) {
    std::unique_ptr<GbmSurfaces> out(new GbmSurfaces(device));
    if (auto begun = out->begin(file); !begun) return tl::unexpected(begun.error());
    return out;
}

GbmSurfaces::~GbmSurfaces() {
    if (context_ != EGL_NO_CONTEXT) {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }
    if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
    if (gbm_ != nullptr) gbm_device_destroy(gbm_);
}

Result<void> GbmSurfaces::begin(int file) {
    gbm_ = gbm_create_device(file);
    if (gbm_ == nullptr) return fail("Mesa or the driver has no buffers (GBM) for " + device_.name());
    const char* known = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!has_word(known, "EGL_KHR_platform_gbm") && !has_word(known, "EGL_MESA_platform_gbm"))
        return fail("EGL cannot draw to buffers of monitors here (it lacks EGL_KHR_platform_gbm)");
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, gbm_, nullptr);
    if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE)
        return fail("EGL cannot use " + device_.name() + " (" + egl_error("eglInitialize") + ")");
    config_ = find_config(display_);
    if (config_ == nullptr) return fail("EGL cannot draw pixels of 8 bits a channel (XRGB8888) for " + device_.name());
    context_ = create_egl_context(display_);
    if (context_ == EGL_NO_CONTEXT)
        return fail("EGL offers no OpenGL 4.5 compatibility context on " + device_.name() + " (" +
                    egl_error("eglCreateContext") + ")");
    return {};
}

Result<std::unique_ptr<ScanoutSurface>> GbmSurfaces::make(const Mode& mode) {
    auto out = std::make_unique<Surface>(*this);
    if (auto opened = out->open(mode); !opened) return tl::unexpected(opened.error());
    return out;
}

Result<void> GbmSurfaces::select_none() {
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE)
        return fail(egl_error("eglMakeCurrent"));
    return {};
}

void GbmSurfaces::clear(std::uint32_t rgb) {
    Gl gl;
    gl.load([](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); });
    const auto channel = [rgb](unsigned shift) { return static_cast<float>(rgb >> shift & 0xff) / 255; };
    gl.ClearColor(channel(16), channel(8), channel(0), 1);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.ClearColor(0, 0, 0, 0);
}

}  // namespace wall::tileserver
