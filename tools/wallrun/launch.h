// SPDX-License-Identifier: MIT
// What must be right before a program is started on the wall, and the environment that puts it there. wallctl doctor
// uses the same checks. One thread.
#pragma once

#include <map>
#include <string>

#include "common/base/result.h"
#include "common/net/address.h"

namespace wall::wallrun {

struct Launch {
    std::string walld = net::kDefaultWalld;
    std::string rect;  ///< "X,Y,W,H", "fullscreen" or nothing
    std::string name;
    bool hold = false;
    std::string stereo;  ///< "PERCENT", "PERCENT,DISTANCE" or nothing
    bool sort_last = false;
    std::string lossy_pixels;  ///< a number or nothing
    std::string camera;        ///< names of uniforms, with commas between them, or nothing
};

/// Where the vendor libraries are: beside this program's own installation.
struct VendorFiles {
    std::string folder;    ///< holds libGLX_wallgl.so.0 and libEGL_wallgl.so.0
    std::string egl_json;  ///< GLVND's description of the EGL one
};

/// `tool` is this program's own path (/proc/self/exe).
Result<VendorFiles> find_vendor(const std::string& tool);
/// Both libraries exist and load: GLVND itself would fall back to Mesa without a word.
Result<void> check_vendor(const VendorFiles& files);
/// walld answers and lets this user in. `answer_json`, if given, gets its status.
Result<void> check_walld(const std::string& address, std::string* answer_json = nullptr);
Result<void> check_rect(const std::string& rect);
Result<void> check_stereo(const std::string& stereo, bool parallel);
Result<void> check_camera(const std::string& camera);
Result<void> check_lossy_pixels(const std::string& pixels);

/// Variables to set; LD_LIBRARY_PATH goes before what is there (`library_path`).
std::map<std::string, std::string> environment_for(const Launch& launch, const VendorFiles& files,
                                                   const std::string& library_path);

}  // namespace wall::wallrun
