// SPDX-License-Identifier: MIT
#include "tileserver/gpu/egl_context.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace wall::tileserver {
namespace {

constexpr std::array kEglContextAttributes = {
    EGL_CONTEXT_MAJOR_VERSION,
    4,
    EGL_CONTEXT_MINOR_VERSION,
    5,
    EGL_CONTEXT_OPENGL_PROFILE_MASK,
    EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
    EGL_NONE,
};

/// With a notice when the GPU is reset (Driver::reset()); not every driver gives one.
constexpr auto kResetAttributes = [] {
    std::array<EGLint, kEglContextAttributes.size() + 2> wanted{};
    std::ranges::copy(kEglContextAttributes, wanted.begin());
    wanted[kEglContextAttributes.size() - 1] = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY;
    wanted[kEglContextAttributes.size()] = EGL_LOSE_CONTEXT_ON_RESET;
    wanted.back() = EGL_NONE;
    return wanted;
}();

}  // namespace

std::string egl_error(const char* call) {
    std::array<char, 32> code{};
    std::snprintf(code.data(), code.size(), "0x%04x", static_cast<unsigned>(eglGetError()));
    return std::string(call) + " failed, EGL error " + code.data();
}

bool has_word(const char* list, std::string_view word) {
    for (std::string_view rest = list != nullptr ? list : ""; !rest.empty();) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        if (rest.substr(0, end) == word) return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

EGLContext create_egl_context(EGLDisplay display) {
    if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return EGL_NO_CONTEXT;
    for (const EGLint* attributes : {kResetAttributes.data(), kEglContextAttributes.data()}) {
        const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        if (context != EGL_NO_CONTEXT) return context;
    }
    return EGL_NO_CONTEXT;
}

}  // namespace wall::tileserver
