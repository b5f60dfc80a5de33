// SPDX-License-Identifier: MIT
#include "client_lib/vendor/config_matrix.h"

#include <algorithm>
#include <span>

namespace wall::client::vendor {

namespace {

/// Where pixels have several samples there is no accumulation buffer.
std::vector<SurfaceFormat> formats_of(std::uint8_t samples, bool with_alpha_only, bool with_single_and_accum) {
    const std::vector<bool> flags{true, false};
    std::vector<SurfaceFormat> formats;
    for (const bool alpha : flags)
        for (const bool double_buffered : flags)
            for (const bool depth : flags)
                for (const bool stencil : flags)
                    for (const bool accum : flags) {
                        if (with_alpha_only && !alpha) continue;
                        if (!with_single_and_accum && (!double_buffered || accum)) continue;
                        if (samples != 0 && accum) continue;
                        SurfaceFormat format;
                        format.alpha_bits = alpha ? 8 : 0;
                        format.double_buffered = double_buffered;
                        format.depth_bits = depth ? 24 : 0;
                        format.stencil_bits = stencil ? 8 : 0;
                        format.accum_bits = accum ? 16 : 0;
                        format.samples = samples;
                        formats.push_back(format);
                    }
    std::stable_sort(formats.begin(), formats.end(),
                     [](const auto& a, const auto& b) { return a.alpha_bits < b.alpha_bits; });
    return formats;
}

}  // namespace

std::vector<SurfaceFormat> format_matrix(bool with_alpha_only, bool with_single_and_accum, bool stereo) {
    std::vector<SurfaceFormat> formats;
    for (const std::uint8_t samples : {std::uint8_t{0}, kWindowSamples})
        for (SurfaceFormat format : formats_of(samples, with_alpha_only, with_single_and_accum)) {
            if (stereo && !format.double_buffered) continue;
            format.stereo = stereo;
            formats.push_back(format);
        }
    return formats;
}

ScreenVisuals screen_visuals(Display* display, int screen) {
    ScreenVisuals found;
    XVisualInfo wanted{};
    wanted.screen = screen;
    int count = 0;
    XVisualInfo* all = XGetVisualInfo(display, VisualScreenMask, &wanted, &count);
    if (!all) return found;
    const auto default_id = XVisualIDFromVisual(DefaultVisual(display, screen));
    const int default_depth = DefaultDepth(display, screen);
    for (const XVisualInfo& visual : std::span(all, static_cast<std::size_t>(count))) {
        if (visual.c_class != TrueColor) continue;
        if (visual.depth == 32 && default_depth != 32) {
            if (found.argb.empty()) found.argb.push_back(visual);
        } else if (visual.visualid == default_id) {
            found.opaque.insert(found.opaque.begin(), visual);
        } else if (visual.depth == default_depth) {
            found.opaque.push_back(visual);
        }
    }
    XFree(all);
    return found;
}

}  // namespace wall::client::vendor
