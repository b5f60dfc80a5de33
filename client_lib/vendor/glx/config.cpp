// SPDX-License-Identifier: MIT
#include "client_lib/vendor/glx/config.h"

#include <map>
#include <memory>
#include <string>
#include <unordered_set>

#include "client_lib/vendor/config_matrix.h"

namespace wall::client::glx {

/// Every screen seen so far. Lives for ever.
struct Screens {
    std::mutex mutex;
    std::map<std::pair<std::string, int>, std::unique_ptr<Screen>> by_name;
    std::unordered_set<const void*> configs;

    static Screens& get() {
        static Screens& only = *new Screens;
        return only;
    }
    Screen& find(Display* display, int number) {
        std::lock_guard lock(mutex);
        auto& screen = by_name[{DisplayString(display), number}];
        if (!screen) {
            screen.reset(new Screen(display, number));
            configs.insert(screen->configs_.begin(), screen->configs_.end());
        }
        return *screen;
    }
};

namespace {

constexpr int kFirstConfigId = 0x101;

int buffer_size(const Config& c) { return 24 + c.format.alpha_bits; }

}  // namespace

const Config* Config::from(GLXFBConfig handle) {
    auto& screens = Screens::get();
    std::lock_guard lock(screens.mutex);
    return screens.configs.contains(handle) ? reinterpret_cast<const Config*>(handle) : nullptr;
}

Screen& Screen::of(Display* display, int number) { return Screens::get().find(display, number); }

Screen::Screen(Display* display, int number) {
    const auto visuals = vendor::screen_visuals(display, number);
    int id = kFirstConfigId;
    const auto add = [&](const XVisualInfo& visual, const SurfaceFormat& format) {
        auto* config = new Config{id++, number, visual.visualid, visual.depth, format};
        configs_.push_back(config);
        by_visual_.try_emplace(visual.visualid, config);
    };
    std::size_t next = 0;
    // Those for two eyes last: who names a visual alone gets one of the others.
    for (const bool stereo : {false, true}) {
        for (const auto& format : vendor::format_matrix(false, true, stereo)) {
            if (visuals.opaque.empty()) break;
            add(visuals.opaque[next < visuals.opaque.size() ? next : 0], format);
            ++next;
        }
        if (!visuals.argb.empty())
            for (const auto& format : vendor::format_matrix(true, true, stereo)) add(visuals.argb.front(), format);
    }
}

const Config* Screen::of_visual(VisualID visual) const {
    std::lock_guard lock(mutex_);
    const auto found = by_visual_.find(visual);
    return found != by_visual_.end() ? found->second : nullptr;
}

void Screen::choose_for_visual(const Config& config) {
    std::lock_guard lock(mutex_);
    by_visual_[config.visual] = &config;
}

std::optional<int> visual_attribute(const Config& c, int name) {
    switch (name) {
        case GLX_USE_GL: return 1;
        case GLX_RGBA: return 1;
        case GLX_BUFFER_SIZE: return buffer_size(c);
        case GLX_LEVEL: return 0;
        case GLX_DOUBLEBUFFER: return c.format.double_buffered;
        case GLX_STEREO: return c.format.stereo;
        case GLX_AUX_BUFFERS: return 0;
        case GLX_RED_SIZE:
        case GLX_GREEN_SIZE:
        case GLX_BLUE_SIZE: return 8;
        case GLX_ALPHA_SIZE: return c.format.alpha_bits;
        case GLX_DEPTH_SIZE: return c.format.depth_bits;
        case GLX_STENCIL_SIZE: return c.format.stencil_bits;
        case GLX_ACCUM_RED_SIZE:
        case GLX_ACCUM_GREEN_SIZE:
        case GLX_ACCUM_BLUE_SIZE: return c.format.accum_bits;
        case GLX_ACCUM_ALPHA_SIZE: return c.format.alpha_bits ? c.format.accum_bits : 0;
        case GLX_SAMPLE_BUFFERS: return c.format.samples > 0;
        case GLX_SAMPLES: return c.format.samples;
        case GLX_X_VISUAL_TYPE: return GLX_TRUE_COLOR;
        case GLX_CONFIG_CAVEAT: return GLX_NONE;
        case GLX_TRANSPARENT_TYPE: return GLX_NONE;
        default: break;
    }
    if (name >= GLX_TRANSPARENT_INDEX_VALUE && name <= GLX_TRANSPARENT_ALPHA_VALUE) return 0;
    return std::nullopt;
}

std::optional<int> attribute(const Config& c, int name) {
    switch (name) {
        case GLX_FBCONFIG_ID: return c.id;
        case GLX_VISUAL_ID: return static_cast<int>(c.visual);
        case GLX_RENDER_TYPE: return GLX_RGBA_BIT;
        case GLX_DRAWABLE_TYPE: return GLX_WINDOW_BIT | GLX_PIXMAP_BIT | GLX_PBUFFER_BIT;
        case GLX_X_RENDERABLE: return 1;
        case GLX_SCREEN: return c.screen;
        case GLX_MAX_PBUFFER_WIDTH:
        case GLX_MAX_PBUFFER_HEIGHT: return vendor::kMaxPbufferExtent;
        case GLX_MAX_PBUFFER_PIXELS: return vendor::kMaxPbufferExtent * vendor::kMaxPbufferExtent;
        case GLX_OPTIMAL_PBUFFER_WIDTH_SGIX:
        case GLX_OPTIMAL_PBUFFER_HEIGHT_SGIX: return 0;
        case GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB: return 1;
        case GLX_RGBA:
        case GLX_USE_GL: return std::nullopt;
        default: return visual_attribute(c, name);
    }
}

}  // namespace wall::client::glx
