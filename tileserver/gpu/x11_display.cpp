// SPDX-License-Identifier: MIT
#include "tileserver/gpu/x11_display.h"

#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>
#include <X11/extensions/scrnsaver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr double kUsualRate = 60;  // Hz

// Xlib has one handler of errors a process and calls it in the thread that reads them. Its own would end the process.
// What is refused while windows are made is looked at by check_requests(); later there are only the driver's own
// requests, which it sends without waiting.
thread_local int refused_code = 0;
int note_error(Display*, XErrorEvent* error) {
    refused_code = error->error_code;
    return 0;
}
int keep_silent(Display*) { return 0; }  // the exit handler below says what is to be said

template <class T, void (*kFree)(T*)>
struct Freed {
    void operator()(T* data) const { kFree(data); }
};
template <class T, void (*kFree)(T*)>
using Owned = std::unique_ptr<T, Freed<T, kFree>>;

geom::Rect rect_of(const XRRMonitorInfo& monitor) { return {monitor.x, monitor.y, monitor.width, monitor.height}; }

std::string atom_text(Display* display, Atom atom) {
    char* text = XGetAtomName(display, atom);
    std::string out = text != nullptr ? text : "";
    if (text != nullptr) XFree(text);
    return out;
}

std::string described(const std::string& name, const geom::Rect& rect) {
    return "\"" + name + "\" (" + std::to_string(rect.width) + "x" + std::to_string(rect.height) + "+" +
           std::to_string(rect.x) + "+" + std::to_string(rect.y) + ")";
}

/// Hz; 0: not known.
double rate_of(const XRRScreenResources& resources, RRMode mode) {
    for (const XRRModeInfo& known : std::span(resources.modes, static_cast<std::size_t>(resources.nmode)))
        if (known.id == mode && known.hTotal != 0 && known.vTotal != 0)
            return static_cast<double>(known.dotClock) / known.hTotal / known.vTotal;
    return 0;
}

}  // namespace

Result<std::unique_ptr<X11Display>> X11Display::open(const std::string& wanted) {
    const std::string name = XDisplayName(wanted.empty() ? nullptr : wanted.c_str());
    if (name.empty())
        return fail("a tile is a window, but on which X display is not said: set 'display' in wall.toml, or DISPLAY");
    std::unique_ptr<X11Display> out(new X11Display(name));
    XSetErrorHandler(note_error);
    XSetIOErrorHandler(keep_silent);
    out->display_ = XOpenDisplay(name.c_str());
    if (out->display_ == nullptr)
        return fail("the X display \"" + name +
                    "\" cannot be opened: is an X server running there, and does XAUTHORITY name its key?");
    XSetIOErrorExitHandler(
        out->display_, [](Display*, void* self) { static_cast<X11Display*>(self)->lost_ = true; }, out.get());
    out->watch_.emplace(ConnectionNumber(out->display_), out->gone());
    return out;
}

X11Display::~X11Display() {
    watch_.reset();
    if (display_ != nullptr) XCloseDisplay(display_);
}

std::string X11Display::gone() const { return "the X server of display \"" + name_ + "\" has gone away"; }

Result<geom::Rect> X11Display::monitor(const std::string& wanted) const {
    int event = 0, error = 0, major = 0, minor = 0;
    if (!XRRQueryExtension(display_, &event, &error) || !XRRQueryVersion(display_, &major, &minor) ||
        std::pair(major, minor) < std::pair(1, 5))
        return fail("the X display \"" + name_ +
                    "\" does not name its monitors (RandR 1.5): use 'position' in place of 'monitor'");
    int count = 0;
    const Owned<XRRMonitorInfo, XRRFreeMonitors> monitors(
        XRRGetMonitors(display_, DefaultRootWindow(display_), True, &count));
    std::string known;
    for (const XRRMonitorInfo& monitor : std::span(monitors.get(), static_cast<std::size_t>(std::max(0, count)))) {
        const auto name = atom_text(display_, monitor.name);
        if (name == wanted) return rect_of(monitor);
        known += (known.empty() ? "" : ", ") + described(name, rect_of(monitor));
    }
    return fail("the X display \"" + name_ + "\" has no monitor \"" + wanted +
                "\": " + (known.empty() ? "none is on" : "it has " + known));
}

std::chrono::nanoseconds X11Display::refresh_period() const {
    int event = 0, error = 0;
    double fastest = 0;
    if (XRRQueryExtension(display_, &event, &error)) {
        const Owned<XRRScreenResources, XRRFreeScreenResources> resources(
            XRRGetScreenResourcesCurrent(display_, DefaultRootWindow(display_)));
        for (const RRCrtc crtc : std::span(resources ? resources->crtcs : nullptr,
                                           resources ? static_cast<std::size_t>(resources->ncrtc) : 0)) {
            const Owned<XRRCrtcInfo, XRRFreeCrtcInfo> info(XRRGetCrtcInfo(display_, resources.get(), crtc));
            if (info && info->mode != None) fastest = std::max(fastest, rate_of(*resources, info->mode));
        }
    }
    return std::chrono::nanoseconds(std::llround(1e9 / (fastest >= 1 ? fastest : kUsualRate)));
}

void X11Display::suspend_screen_saver() const {
    int event = 0, error = 0, major = 0, minor = 0;
    if (!XScreenSaverQueryExtension(display_, &event, &error) || !XScreenSaverQueryVersion(display_, &major, &minor))
        return;
    if (std::pair(major, minor) >= std::pair(1, 1)) XScreenSaverSuspend(display_, True);
}

Result<void> X11Display::check_requests(const std::string& what) const {
    XSync(display_, False);
    if (lost_) return fail(gone());
    if (const int code = std::exchange(refused_code, 0); code != 0) {
        std::array<char, 128> text{};
        XGetErrorText(display_, code, text.data(), static_cast<int>(text.size()));
        return fail("the X display \"" + name_ + "\" refused " + what + ": " + text.data());
    }
    return {};
}

}  // namespace wall::tileserver
