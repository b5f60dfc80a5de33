// SPDX-License-Identifier: MIT
// The OSMesa backend. The library is opened with RTLD_LOCAL, so that its gl* symbols meet nobody else's, and never
// closed (it leaves threads behind). Render thread.
#include <GL/gl.h>
#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <utility>

#include "tileserver/gpu/backend.h"

namespace wall::tileserver {
namespace {

struct OsMesa {
    OSMesaContext (*create_context)(const int*, OSMesaContext) = nullptr;
    void (*destroy_context)(OSMesaContext) = nullptr;
    GLboolean (*make_current)(OSMesaContext, void*, GLenum, GLsizei, GLsizei) = nullptr;
    OSMESAproc (*get_proc_address)(const char*) = nullptr;
};

constexpr std::array kMesaContextAttributes = {
    OSMESA_FORMAT,
    OSMESA_RGBA,
    OSMESA_DEPTH_BITS,
    0,
    OSMESA_STENCIL_BITS,
    0,
    OSMESA_ACCUM_BITS,
    0,
    OSMESA_PROFILE,
    OSMESA_COMPAT_PROFILE,
    OSMESA_CONTEXT_MAJOR_VERSION,
    4,
    OSMESA_CONTEXT_MINOR_VERSION,
    5,
    0,
};

Result<OsMesa> load_library() {
    void* library = nullptr;
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
        if (library == nullptr) library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return fail("OSMesa is not installed (Debian package libosmesa6); use backend = \"egl\"");
    OsMesa mesa;
    const auto load = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
        return function != nullptr;
    };
    if (!load(mesa.create_context, "OSMesaCreateContextAttribs") ||
        !load(mesa.destroy_context, "OSMesaDestroyContext") || !load(mesa.make_current, "OSMesaMakeCurrent") ||
        !load(mesa.get_proc_address, "OSMesaGetProcAddress"))
        return fail("the OSMesa library is too old: it lacks OSMesaCreateContextAttribs");
    return mesa;
}

class OsMesaBackend final : public GlBackend {
public:
    OsMesaBackend(const OsMesa& mesa, OSMesaContext context) : mesa_(mesa), context_(context) {}
    ~OsMesaBackend() override {
        mesa_.make_current(nullptr, nullptr, 0, 0, 0);
        mesa_.destroy_context(context_);
    }
    Result<void> make_current() override {
        if (mesa_.make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, kExtent, kExtent) == GL_FALSE)
            return fail("OSMesaMakeCurrent failed");
        return {};
    }
    void* get_proc_address(const char* name) const override {
        return reinterpret_cast<void*>(mesa_.get_proc_address(name));
    }
    std::string_view name() const override { return "osmesa"; }

private:
    static constexpr int kExtent = 16;  // pixels; OSMesa insists on a default framebuffer, which is never drawn to
    OsMesa mesa_;
    OSMesaContext context_;
    std::array<std::byte, kExtent * kExtent * 4> pixels_{};
};

}  // namespace

Result<std::unique_ptr<GlBackend>> open_osmesa_backend() {
    auto mesa = load_library();
    if (!mesa) return tl::unexpected(mesa.error());
    const OSMesaContext context = mesa->create_context(kMesaContextAttributes.data(), nullptr);
    if (context == nullptr) return fail("OSMesa offers no OpenGL 4.5 compatibility context");
    return std::make_unique<OsMesaBackend>(*mesa, context);
}

}  // namespace wall::tileserver
