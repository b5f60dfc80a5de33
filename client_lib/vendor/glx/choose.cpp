// SPDX-License-Identifier: MIT
// glXChooseFBConfig and glXChooseVisual: which configurations fit, and the order of those that do (GLX 1.4, 3.3.3).

#include <algorithm>
#include <array>
#include <unordered_map>

#include "client_lib/vendor/glx/config.h"

namespace wall::client::glx {
namespace {

constexpr int kDontCare = static_cast<int>(GLX_DONT_CARE);

enum class Match { exact, at_least, mask, ignored };

struct Criterion {
    int name;
    Match match;
    int value;  ///< default
};

constexpr std::array kCriteria{
    Criterion{GLX_FBCONFIG_ID, Match::exact, kDontCare},
    Criterion{GLX_BUFFER_SIZE, Match::at_least, 0},
    Criterion{GLX_LEVEL, Match::exact, 0},
    Criterion{GLX_DOUBLEBUFFER, Match::exact, kDontCare},
    Criterion{GLX_STEREO, Match::exact, 0},
    Criterion{GLX_AUX_BUFFERS, Match::at_least, 0},
    Criterion{GLX_RED_SIZE, Match::at_least, 0},
    Criterion{GLX_GREEN_SIZE, Match::at_least, 0},
    Criterion{GLX_BLUE_SIZE, Match::at_least, 0},
    Criterion{GLX_ALPHA_SIZE, Match::at_least, 0},
    Criterion{GLX_DEPTH_SIZE, Match::at_least, 0},
    Criterion{GLX_STENCIL_SIZE, Match::at_least, 0},
    Criterion{GLX_ACCUM_RED_SIZE, Match::at_least, 0},
    Criterion{GLX_ACCUM_GREEN_SIZE, Match::at_least, 0},
    Criterion{GLX_ACCUM_BLUE_SIZE, Match::at_least, 0},
    Criterion{GLX_ACCUM_ALPHA_SIZE, Match::at_least, 0},
    Criterion{GLX_SAMPLE_BUFFERS, Match::at_least, 0},
    Criterion{GLX_SAMPLES, Match::at_least, 0},
    Criterion{GLX_RENDER_TYPE, Match::mask, GLX_RGBA_BIT},
    Criterion{GLX_DRAWABLE_TYPE, Match::mask, GLX_WINDOW_BIT},
    Criterion{GLX_X_RENDERABLE, Match::exact, kDontCare},
    Criterion{GLX_X_VISUAL_TYPE, Match::exact, kDontCare},
    Criterion{GLX_CONFIG_CAVEAT, Match::exact, kDontCare},
    Criterion{GLX_TRANSPARENT_TYPE, Match::exact, GLX_NONE},
    Criterion{GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB, Match::at_least, 0},  // all are, and until it is turned on none shows
    Criterion{GLX_VISUAL_ID, Match::ignored, 0},
    Criterion{GLX_SCREEN, Match::ignored, 0},
    Criterion{GLX_MAX_PBUFFER_WIDTH, Match::ignored, 0},
    Criterion{GLX_MAX_PBUFFER_HEIGHT, Match::ignored, 0},
    Criterion{GLX_MAX_PBUFFER_PIXELS, Match::ignored, 0},
    Criterion{GLX_TRANSPARENT_INDEX_VALUE, Match::ignored, 0},
    Criterion{GLX_TRANSPARENT_RED_VALUE, Match::ignored, 0},
    Criterion{GLX_TRANSPARENT_GREEN_VALUE, Match::ignored, 0},
    Criterion{GLX_TRANSPARENT_BLUE_VALUE, Match::ignored, 0},
    Criterion{GLX_TRANSPARENT_ALPHA_VALUE, Match::ignored, 0},
};

/// What a program asks for: a value for each criterion.
class Wish {
public:
    Wish() {
        for (const auto& c : kCriteria) values_[c.name] = c.value;
    }
    bool set(int name, int value) {
        const auto found = values_.find(name);
        if (found == values_.end()) return false;
        found->second = value;
        return true;
    }
    int operator[](int name) const { return values_.at(name); }

    bool fits(const Config& config) const {
        if ((*this)[GLX_FBCONFIG_ID] != kDontCare) return (*this)[GLX_FBCONFIG_ID] == config.id;
        return std::all_of(kCriteria.begin(), kCriteria.end(), [&](const auto& c) { return fits(config, c); });
    }

private:
    bool fits(const Config& config, const Criterion& c) const {
        const int wanted = (*this)[c.name];
        if (c.match == Match::ignored || wanted == kDontCare) return true;
        const auto has = attribute(config, c.name);
        if (!has) return false;
        if (c.match == Match::exact) return *has == wanted;
        if (c.match == Match::mask) return (*has & wanted) == wanted;
        return *has >= wanted;
    }
    std::unordered_map<int, int> values_;
};

/// Sum of the sizes that the program asked for.
int asked_bits(const Config& config, const Wish& wish, std::initializer_list<int> names) {
    int bits = 0;
    for (const int name : names)
        if (wish[name] != 0 && wish[name] != kDontCare) bits += attribute(config, name).value_or(0);
    return bits;
}

/// Sorts by this key, smaller first. `zero_depth_first`: glXChooseVisual prefers no depth buffer if none was asked for.
std::array<int, 7> rank(const Config& config, const Wish& wish, bool zero_depth_first) {
    const int depth = config.format.depth_bits;
    return {-asked_bits(config, wish, {GLX_RED_SIZE, GLX_GREEN_SIZE, GLX_BLUE_SIZE, GLX_ALPHA_SIZE}),
            *attribute(config, GLX_BUFFER_SIZE),
            config.format.double_buffered,
            config.format.samples,
            zero_depth_first && wish[GLX_DEPTH_SIZE] == 0 ? depth : -depth,
            config.format.stencil_bits,
            config.format.accum_bits};  // never more than asked for: it costs every node memory
}

std::vector<const Config*> choose(const Screen& screen, const Wish& wish, bool zero_depth_first) {
    std::vector<const Config*> fitting;
    for (const Config* config : screen.configs())
        if (wish.fits(*config)) fitting.push_back(config);
    std::stable_sort(fitting.begin(), fitting.end(), [&](const Config* a, const Config* b) {
        return rank(*a, wish, zero_depth_first) < rank(*b, wish, zero_depth_first);
    });
    return fitting;
}

}  // namespace

std::vector<const Config*> choose_configs(const Screen& screen, const int* attributes) {
    Wish wish;
    for (const int* a = attributes; a && *a != None; a += 2)
        if (!wish.set(a[0], a[1])) return {};
    return choose(screen, wish, false);
}

const Config* choose_visual(const Screen& screen, const int* attributes) {
    Wish wish;
    bool rgba = false;
    wish.set(GLX_DOUBLEBUFFER, 0);
    for (const int* a = attributes; a && *a != None;) {
        const int name = *a++;
        if (name == GLX_RGBA) {
            rgba = true;
        } else if (name == GLX_DOUBLEBUFFER || name == GLX_STEREO) {
            wish.set(name, 1);
        } else if (name == GLX_USE_GL) {
            continue;
        } else if (!wish.set(name, *a++)) {
            return nullptr;
        }
    }
    if (!rgba) return nullptr;
    const auto fitting = choose(screen, wish, true);
    return fitting.empty() ? nullptr : fitting.front();
}

}  // namespace wall::client::glx
