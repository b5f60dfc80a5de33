// SPDX-License-Identifier: MIT
#include "tileserver/gpu/gpu_devices.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/egl_context.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostDevices = 64;
constexpr std::string_view kUsualDomain = "0000:";

std::string listed(std::span<const GpuDevice> gpus) {
    if (gpus.empty()) return "EGL knows none but software renderers";
    std::string out = "there are ";
    for (std::size_t i = 0; i < gpus.size(); ++i)
        out += (i == 0 ? "" : ", ") + std::to_string(i) + (gpus[i].pci.empty() ? "" : " (" + gpus[i].pci + ")");
    return out;
}

}  // namespace

/// The kernel names a PCI device's folder by its address.
std::string pci_address(const std::string& drm_file) {
    std::error_code error;
    const auto link = fs::path("/sys/class/drm") / fs::path(drm_file).filename() / "device";
    const auto name = fs::canonical(link, error).filename().string();
    return !error && std::ranges::count(name, ':') == 2 ? name : std::string();
}

std::vector<GpuDevice> gpu_devices() {
    const auto query_devices = egl_extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto query_string = egl_extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    if (query_devices == nullptr || query_string == nullptr) return {};
    std::array<EGLDeviceEXT, kMostDevices> devices{};
    EGLint count = 0;
    if (query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_FALSE) return {};
    std::vector<GpuDevice> out;
    for (const EGLDeviceEXT device : std::span(devices).first(static_cast<std::size_t>(count))) {
        const char* extensions = query_string(device, EGL_EXTENSIONS);
        if (has_word(extensions, "EGL_MESA_device_software")) continue;
        const bool has_file = has_word(extensions, "EGL_EXT_device_drm");
        const char* file = has_file ? query_string(device, EGL_DRM_DEVICE_FILE_EXT) : nullptr;
        out.push_back({device, file != nullptr ? pci_address(file) : ""});
    }
    return out;
}

Result<std::size_t> choose_gpu(std::span<const GpuDevice> gpus, std::string_view wanted) {
    std::size_t number = 0;
    const char* const end = wanted.data() + wanted.size();
    const bool is_number = std::from_chars(wanted.data(), end, number).ptr == end && !wanted.empty();
    if (wanted == kAnyGpu || (gpus.empty() && is_number)) return 0;
    if (is_number && number < gpus.size()) return number;
    const auto found = std::ranges::find_if(gpus, [&](const GpuDevice& gpu) {
        return !gpu.pci.empty() && (gpu.pci == wanted || gpu.pci == std::string(kUsualDomain) + std::string(wanted));
    });
    if (found != gpus.end()) return static_cast<std::size_t>(found - gpus.begin());
    return fail("there is no GPU '" + std::string(wanted) + "': " + listed(gpus));
}

std::string gpu_table() {
    const auto gpus = gpu_devices();
    if (gpus.empty()) return "EGL knows no GPU here, but software renderers: nodes use these.\n";
    std::string out = "GPU  PCI           RENDERER\n";
    for (std::size_t i = 0; i < gpus.size(); ++i) {
        const auto backend = open_egl_backend(std::to_string(i));
        std::string renderer = backend ? "?" : backend.error().message;
        if (backend && (*backend)->make_current()) {
            Gl gl;
            gl.load([&](const char* name) { return (*backend)->get_proc_address(name); });
            const auto* text = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
            if (text != nullptr) renderer = text;
        }
        auto number = std::to_string(i), pci = gpus[i].pci.empty() ? "-" : gpus[i].pci;
        number.resize(std::max<std::size_t>(number.size(), 5), ' ');
        pci.resize(std::max<std::size_t>(pci.size(), 14), ' ');
        out += number + pci + renderer + "\n";
    }
    return out;
}

}  // namespace wall::tileserver
