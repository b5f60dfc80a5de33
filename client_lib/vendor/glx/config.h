// SPDX-License-Identifier: MIT
// GLXFBConfigs. A handle is the address of a Config, which lives for ever: programs look one up on one display and use
// it on another. Any thread.
#pragma once

#include <GL/glx.h>

#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "client_lib/context/core.h"

namespace wall::client::glx {

struct Config {
    int id = 0;
    int screen = 0;
    VisualID visual = 0;
    int visual_depth = 0;
    SurfaceFormat format;

    GLXFBConfig handle() const { return reinterpret_cast<GLXFBConfig>(const_cast<Config*>(this)); }
    /// Null if the handle is none of ours.
    static const Config* from(GLXFBConfig handle);
};

/// The configurations of one screen. The server's many equal visuals are shared out among them, so that a program that
/// knows only a visual (glXCreateContext) gets what it chose.
class Screen {
public:
    static Screen& of(Display* display, int number);

    std::span<const Config* const> configs() const { return configs_; }
    /// Null for a visual that is not offered.
    const Config* of_visual(VisualID visual) const;
    /// glXChooseVisual has answered `config`: where several share a visual, it now stands for this one.
    void choose_for_visual(const Config& config);

private:
    friend struct Screens;
    Screen(Display* display, int number);
    std::vector<const Config*> configs_;
    mutable std::mutex mutex_;
    std::unordered_map<VisualID, const Config*> by_visual_;
};

/// glXGetFBConfigAttrib's answer; nothing for an unknown attribute.
std::optional<int> attribute(const Config& config, int name);
/// The same for an XVisualInfo (glXGetConfig knows fewer, older names).
std::optional<int> visual_attribute(const Config& config, int name);

/// Best first, as GLX 1.4 table 3.4 sorts. A malformed or unknown attribute gives nothing.
std::vector<const Config*> choose_configs(const Screen& screen, const int* attributes);
/// As glXChooseVisual; null if nothing fits.
const Config* choose_visual(const Screen& screen, const int* attributes);

}  // namespace wall::client::glx
