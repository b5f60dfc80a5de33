// SPDX-License-Identifier: MIT
#include "client_lib/process/options.h"

#include <cstdlib>
#include <cstring>

#include "client_lib/process/log.h"
#include "common/base/camera_names.h"
#include "common/base/lossy_pixels.h"

namespace wall::client {
namespace {

bool is(const char* name, const char* wanted) {
    const char* value = secure_getenv(name);
    return value && std::strcmp(value, wanted) == 0;
}

Coding coding() {
    return is("WALLGL_CODING", "0") ? Coding::never : is("WALLGL_CODING", "1") ? Coding::always : Coding::measured;
}

std::optional<float> lossy_pixels() {
    const char* text = secure_getenv("WALLGL_LOSSY_PIXELS");
    return text == nullptr ? std::nullopt : lossy_pixels_of_text(text);
}

std::vector<std::string> cameras() {
    const char* text = secure_getenv("WALLGL_CAMERA");
    if (text == nullptr || *text == 0) return {};
    auto names = camera_names_of_text(text);
    if (!names) complain_once("WALLGL_CAMERA has something that is no name of a uniform, and is not heeded", "camera");
    return names ? *std::move(names) : std::vector<std::string>();
}

}  // namespace

const Options& options() {
    // Never destroyed: programs draw while they exit.
    static const auto* const read = new Options{is("WALLGL_BROADCAST", "1"),
                                                is("WALLGL_IDEAL", "1"),
                                                is("WALLGL_SHOWN_ONLY", "1"),
                                                !is("WALLGL_RING", "0"),
                                                coding(),
                                                is("WALLGL_SORT_LAST", "1"),
                                                lossy_pixels(),
                                                !is("WALLGL_DRAWN_PARTS", "0"),
                                                !is("WALLGL_HAND_ON", "0"),
                                                cameras()};
    return *read;
}

}  // namespace wall::client
