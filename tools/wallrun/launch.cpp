// SPDX-License-Identifier: MIT
#include "tools/wallrun/launch.h"

#include <dlfcn.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "common/base/camera_names.h"
#include "common/base/lossy_pixels.h"
#include "common/base/stereo.h"
#include "common/net/control_client.h"

namespace wall::wallrun {
namespace {

namespace fs = std::filesystem;
constexpr const char* kGlxVendor = "libGLX_wallgl.so.0";
constexpr const char* kEglVendor = "libEGL_wallgl.so.0";
constexpr const char* kEglJson = "share/glvnd/egl_vendor.d/50_wallgl.json";
constexpr std::chrono::seconds kWalldLimit{3};

Result<void> check_loads(const std::string& path, const char* entry) {
    void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) return fail(std::string("the vendor library does not load: ") + ::dlerror());
    const bool good = ::dlsym(library, entry) != nullptr;
    ::dlclose(library);
    if (!good) return fail(path + " is no GLVND vendor library: it has no " + entry);
    return {};
}

}  // namespace

Result<VendorFiles> find_vendor(const std::string& tool) {
    const auto root = fs::path(tool).parent_path().parent_path();
    const std::array folders{root / "lib", root / WALLGL_LIBDIR};
    for (const auto& folder : folders) {
        std::error_code error;
        if (fs::exists(folder / kGlxVendor, error)) return VendorFiles{folder.string(), (root / kEglJson).string()};
    }
    return fail(std::string("the vendor library ") + kGlxVendor + " is missing: looked in " + folders[0].string() +
                " and " + folders[1].string() + " (build it, or install WallGL completely)");
}

Result<void> check_vendor(const VendorFiles& files) {
    std::error_code error;
    if (!fs::exists(files.egl_json, error))
        return fail(files.egl_json + " is missing: EGL programs would silently use another library");
    auto glx = check_loads(files.folder + "/" + kGlxVendor, "__glx_Main");
    return glx ? check_loads(files.folder + "/" + kEglVendor, "__egl_Main") : glx;
}

Result<void> check_walld(const std::string& text, std::string* answer_json) {
    const auto address = net::Address::parse(text);
    if (!address) return tl::unexpected(address.error());
    const auto unreachable = [&](const Error& why) {
        return fail("walld cannot be reached at " + why.message +
                    " (is it running? --walld or WALLGL_WALLD say where)");
    };
    auto client = net::ControlClient::connect(*address, kWalldLimit);
    if (!client) return unreachable(client.error());
    proto::Envelope request;
    request.mutable_operator_request()->set_request(1);
    request.mutable_operator_request()->set_verb("status");
    const auto sent = client->send(request);
    const auto answer = client->receive(kWalldLimit);  // who is refused may be told so before the request is sent
    if (!answer) return unreachable({address->text() + ": " + (sent ? answer.error() : sent.error()).message});
    if (answer->has_refused()) return fail("walld at " + address->text() + " refused: " + answer->refused().reason());
    if (!answer->has_operator_reply()) return fail(address->text() + " is no walld");
    if (answer_json) *answer_json = answer->operator_reply().json();
    return {};
}

Result<void> check_rect(const std::string& rect) {
    int x = 0, y = 0, width = 0, height = 0;
    char extra = 0;
    if (rect.empty() || rect == "fullscreen") return {};
    if (std::sscanf(rect.c_str(), "%d,%d,%d,%d%c", &x, &y, &width, &height, &extra) == 4 && width > 0 && height > 0)
        return {};
    return fail("rectangle '" + rect +
                "': expected X,Y,W,H in canvas pixels, for example 0,0,1920,1080, or fullscreen");
}

Result<void> check_stereo(const std::string& stereo, bool parallel) {
    if (!stereo.empty() && parallel)
        return fail("stereo '" + stereo +
                    "': the processes of a parallel program draw one picture together; expected another program");
    if (stereo.empty() || stereo_of_text(stereo)) return {};
    return fail("stereo '" + stereo +
                "': expected PERCENT of the window's width, up to 25, or PERCENT,DISTANCE, for example 1.5,40");
}

Result<void> check_camera(const std::string& camera) {
    if (camera.empty() || camera_names_of_text(camera)) return {};
    return fail("camera '" + camera + "': expected up to " + std::to_string(kMostCameraNames) +
                " names of uniforms as the shaders have them, for example viewProjection or camera.proj,matrices[1]");
}

Result<void> check_lossy_pixels(const std::string& pixels) {
    if (pixels.empty() || lossy_pixels_of_text(pixels)) return {};
    return fail("lossy pixels '" + pixels + "': expected a number from 0 to 16, for example 0.25; 0: nothing is lost");
}

std::map<std::string, std::string> environment_for(const Launch& launch, const VendorFiles& files,
                                                   const std::string& library_path) {
    std::map<std::string, std::string> out{
        {"__GLX_VENDOR_LIBRARY_NAME", "wallgl"},
        {"__EGL_VENDOR_LIBRARY_FILENAMES", files.egl_json},
        {"LD_LIBRARY_PATH", library_path.empty() ? files.folder : files.folder + ":" + library_path},
        {"WALLGL_WALLD", launch.walld},
    };
    if (!launch.rect.empty()) out["WALLGL_RECT"] = launch.rect;
    if (!launch.name.empty()) out["WALLGL_NAME"] = launch.name;
    if (launch.hold) out["WALLGL_HOLD"] = "1";
    if (!launch.stereo.empty()) out["WALLGL_STEREO"] = launch.stereo;
    if (launch.sort_last) out["WALLGL_SORT_LAST"] = "1";
    if (!launch.camera.empty()) out["WALLGL_CAMERA"] = launch.camera;
    if (!launch.lossy_pixels.empty()) out["WALLGL_LOSSY_PIXELS"] = launch.lossy_pixels;
    return out;
}

}  // namespace wall::wallrun
