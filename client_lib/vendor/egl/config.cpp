// SPDX-License-Identifier: MIT
// What a configuration is, and eglChooseConfig's rules (EGL 1.5, 3.4.1).
#include <X11/X.h>

#include <algorithm>

#include "client_lib/vendor/config_matrix.h"
#include "client_lib/vendor/egl/display.h"

namespace wall::client::egl {
namespace {

/// What contexts can be made for it.
EGLint conformant() {
    return EGL_OPENGL_BIT | (offers_es(1) ? EGL_OPENGL_ES_BIT : 0) | (offers_es(2) ? EGL_OPENGL_ES2_BIT : 0) |
           (offers_es(3) ? EGL_OPENGL_ES3_BIT : 0);
}

enum class Match { exact, at_least, mask, ignored };

struct Criterion {
    EGLint name;
    Match match;
    EGLint value;  ///< default
};

constexpr std::array kCriteria{
    Criterion{EGL_CONFIG_ID, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_BUFFER_SIZE, Match::at_least, 0},
    Criterion{EGL_RED_SIZE, Match::at_least, 0},
    Criterion{EGL_GREEN_SIZE, Match::at_least, 0},
    Criterion{EGL_BLUE_SIZE, Match::at_least, 0},
    Criterion{EGL_ALPHA_SIZE, Match::at_least, 0},
    Criterion{EGL_LUMINANCE_SIZE, Match::at_least, 0},
    Criterion{EGL_ALPHA_MASK_SIZE, Match::at_least, 0},
    Criterion{EGL_DEPTH_SIZE, Match::at_least, 0},
    Criterion{EGL_STENCIL_SIZE, Match::at_least, 0},
    Criterion{EGL_SAMPLE_BUFFERS, Match::at_least, 0},
    Criterion{EGL_SAMPLES, Match::at_least, 0},
    Criterion{EGL_BIND_TO_TEXTURE_RGB, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_BIND_TO_TEXTURE_RGBA, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_COLOR_BUFFER_TYPE, Match::exact, EGL_RGB_BUFFER},
    Criterion{EGL_CONFIG_CAVEAT, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_CONFORMANT, Match::mask, 0},
    Criterion{EGL_LEVEL, Match::exact, 0},
    Criterion{EGL_MAX_SWAP_INTERVAL, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_MIN_SWAP_INTERVAL, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_NATIVE_RENDERABLE, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_NATIVE_VISUAL_TYPE, Match::exact, EGL_DONT_CARE},
    Criterion{EGL_RENDERABLE_TYPE, Match::mask, EGL_OPENGL_ES_BIT},
    Criterion{EGL_SURFACE_TYPE, Match::mask, EGL_WINDOW_BIT},
    Criterion{EGL_TRANSPARENT_TYPE, Match::exact, EGL_NONE},
    Criterion{EGL_MATCH_NATIVE_PIXMAP, Match::ignored, EGL_NONE},
    Criterion{EGL_NATIVE_VISUAL_ID, Match::ignored, 0},
    Criterion{EGL_MAX_PBUFFER_WIDTH, Match::ignored, 0},
    Criterion{EGL_MAX_PBUFFER_HEIGHT, Match::ignored, 0},
    Criterion{EGL_MAX_PBUFFER_PIXELS, Match::ignored, 0},
    Criterion{EGL_TRANSPARENT_RED_VALUE, Match::ignored, 0},
    Criterion{EGL_TRANSPARENT_GREEN_VALUE, Match::ignored, 0},
    Criterion{EGL_TRANSPARENT_BLUE_VALUE, Match::ignored, 0},
};

/// A value for each criterion, in its order.
using Wish = std::array<EGLint, kCriteria.size()>;

std::size_t index_of(EGLint name) {
    const auto found = std::find_if(kCriteria.begin(), kCriteria.end(), [&](const auto& c) { return c.name == name; });
    return static_cast<std::size_t>(found - kCriteria.begin());
}

std::optional<Wish> read_wish(const EGLint* attributes) {
    Wish wish;
    for (std::size_t i = 0; i < kCriteria.size(); ++i) wish[i] = kCriteria[i].value;
    for (const EGLint* a = attributes; a && *a != EGL_NONE; a += 2) {
        const auto i = index_of(a[0]);
        if (i == kCriteria.size()) return std::nullopt;
        wish[i] = a[1];
    }
    return wish;
}

bool fits(const Config& config, const Criterion& c, EGLint wanted) {
    if (c.match == Match::ignored || wanted == EGL_DONT_CARE) return true;
    const EGLint has = attribute(config, c.name).value_or(0);
    if (c.match == Match::exact) return has == wanted;
    if (c.match == Match::mask) return (has & wanted) == wanted;
    return has >= wanted;
}

bool fits(const Config& config, const Wish& wish) {
    const auto id = wish[index_of(EGL_CONFIG_ID)];
    if (id != EGL_DONT_CARE) return config.id == id;
    for (std::size_t i = 0; i < kCriteria.size(); ++i)
        if (!fits(config, kCriteria[i], wish[i])) return false;
    return true;
}

/// Sorts by this key, smaller first.
std::array<EGLint, 6> rank(const Config& config, const Wish& wish) {
    EGLint color_bits = 0;
    for (const EGLint name : {EGL_RED_SIZE, EGL_GREEN_SIZE, EGL_BLUE_SIZE, EGL_ALPHA_SIZE}) {
        const EGLint asked = wish[index_of(name)];
        if (asked != 0 && asked != EGL_DONT_CARE) color_bits += *attribute(config, name);
    }
    return {-color_bits,
            *attribute(config, EGL_BUFFER_SIZE),
            config.format.samples,
            config.format.depth_bits,
            config.format.stencil_bits,
            config.id};
}

}  // namespace

std::optional<EGLint> attribute(const Config& c, EGLint name) {
    const EGLint window = c.visual != 0 ? EGL_WINDOW_BIT | EGL_PIXMAP_BIT : 0;
    switch (name) {
        case EGL_BUFFER_SIZE: return 24 + c.format.alpha_bits;
        case EGL_RED_SIZE:
        case EGL_GREEN_SIZE:
        case EGL_BLUE_SIZE: return 8;
        case EGL_ALPHA_SIZE: return c.format.alpha_bits;
        case EGL_DEPTH_SIZE: return c.format.depth_bits;
        case EGL_STENCIL_SIZE: return c.format.stencil_bits;
        case EGL_SAMPLE_BUFFERS: return c.format.samples > 0;
        case EGL_SAMPLES: return c.format.samples;
        case EGL_COLOR_BUFFER_TYPE: return EGL_RGB_BUFFER;
        case EGL_CONFIG_CAVEAT: return EGL_NONE;
        case EGL_CONFIG_ID: return c.id;
        case EGL_CONFORMANT: return conformant();
        case EGL_MAX_PBUFFER_WIDTH:
        case EGL_MAX_PBUFFER_HEIGHT: return vendor::kMaxPbufferExtent;
        case EGL_MAX_PBUFFER_PIXELS: return vendor::kMaxPbufferExtent * vendor::kMaxPbufferExtent;
        case EGL_MAX_SWAP_INTERVAL: return 1;
        case EGL_NATIVE_RENDERABLE: return c.visual != 0;
        case EGL_NATIVE_VISUAL_ID: return static_cast<EGLint>(c.visual);
        case EGL_NATIVE_VISUAL_TYPE: return c.visual != 0 ? TrueColor : EGL_NONE;
        case EGL_RENDERABLE_TYPE: return conformant();
        case EGL_SURFACE_TYPE: return window | EGL_PBUFFER_BIT | EGL_SWAP_BEHAVIOR_PRESERVED_BIT;
        case EGL_TRANSPARENT_TYPE: return EGL_NONE;
        default: break;
    }
    constexpr EGLint kZero[] = {EGL_LUMINANCE_SIZE,
                                EGL_ALPHA_MASK_SIZE,
                                EGL_BIND_TO_TEXTURE_RGB,
                                EGL_BIND_TO_TEXTURE_RGBA,
                                EGL_LEVEL,
                                EGL_MIN_SWAP_INTERVAL,
                                EGL_TRANSPARENT_RED_VALUE,
                                EGL_TRANSPARENT_GREEN_VALUE,
                                EGL_TRANSPARENT_BLUE_VALUE};
    if (std::find(std::begin(kZero), std::end(kZero), name) != std::end(kZero)) return 0;
    return std::nullopt;
}

std::optional<std::vector<const Config*>> choose_configs(const EglDisplay& display, const EGLint* attributes) {
    const auto wish = read_wish(attributes);
    if (!wish) return std::nullopt;
    std::vector<const Config*> fitting;
    for (const auto& config : display.configs())
        if (fits(*config, *wish)) fitting.push_back(config.get());
    std::stable_sort(fitting.begin(), fitting.end(),
                     [&](const Config* a, const Config* b) { return rank(*a, *wish) < rank(*b, *wish); });
    return fitting;
}

}  // namespace wall::client::egl
