// SPDX-License-Identifier: MIT
#include "tileserver/gpu/tile_window.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <initializer_list>

#include "tileserver/gpu/x11_visual.h"

namespace wall::tileserver {
namespace {

Atom atom(Display* display, const char* name) { return XInternAtom(display, name, False); }

/// A property of 32-bit items; Xlib wants them as longs.
void set_property(Display* display, Window window, const char* name, Atom type,
                  std::initializer_list<unsigned long> values) {
    XChangeProperty(display, window, atom(display, name), type, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(values.begin()), static_cast<int>(values.size()));
}

/// Of one pixel that is not drawn.
Cursor empty_cursor(Display* display) {
    constexpr char kNothing[] = {0};
    XColor black{};
    const Pixmap pixmap = XCreateBitmapFromData(display, DefaultRootWindow(display), kNothing, 1, 1);
    const Cursor cursor = XCreatePixmapCursor(display, pixmap, pixmap, &black, &black, 0, 0);
    XFreePixmap(display, pixmap);
    return cursor;
}

}  // namespace

Result<std::unique_ptr<TileWindow>> TileWindow::open(const X11Display& display, const WindowSpec& spec,
                                                     const WindowLook& look) {
    std::unique_ptr<TileWindow> out(new TileWindow(display, spec));
    geom::Rect place = spec.rect;
    if (!spec.monitor.empty()) {
        const auto monitor = display.monitor(spec.monitor);
        if (!monitor) return fail("tile '" + spec.tile + "': " + monitor.error().message);
        place = *monitor;
    }
    if (auto created = out->create(place, look); !created) return tl::unexpected(created.error());
    return out;
}

TileWindow::~TileWindow() {
    Display* display = display_.get();
    if (window_ != 0 && !gone_) XDestroyWindow(display, window_);
    if (colormap_ != 0) XFreeColormap(display, colormap_);
    if (cursor_ != 0) XFreeCursor(display, cursor_);
}

Result<void> TileWindow::create(const geom::Rect& place, const WindowLook& look) {
    Display* display = display_.get();
    const Window root = spec_.parent != 0 ? spec_.parent : DefaultRootWindow(display);
    Visual* visual = true_color_visual(display, look.visual, kWindowDepth);
    XSetWindowAttributes attributes{};
    attributes.background_pixel = look.background;
    attributes.border_pixel = 0;
    attributes.colormap = colormap_ = XCreateColormap(display, root, visual, AllocNone);
    if (spec_.parent == 0) attributes.cursor = cursor_ = empty_cursor(display);
    attributes.event_mask = ExposureMask | StructureNotifyMask;
    resize(place.width, place.height);
    window_ = XCreateWindow(display, root, place.x, place.y, static_cast<unsigned>(width()),
                            static_cast<unsigned>(height()), 0, kWindowDepth, InputOutput, visual,
                            CWBackPixel | CWBorderPixel | CWColormap | CWCursor | CWEventMask, &attributes);
    if (spec_.parent == 0) tell_window_manager(place);
    XMapRaised(display, window_);
    return display_.check_requests("the window of tile '" + spec_.tile + "'");
}

/// ICCCM, EWMH and Motif hints, before the window is mapped. Without a window manager nobody reads them.
void TileWindow::tell_window_manager(const geom::Rect& place) const {
    Display* display = display_.get();
    const std::string title = "WallGL tile " + spec_.tile;
    XSizeHints size{};
    size.flags = USPosition | PPosition | USSize | PSize | PWinGravity;
    size.x = place.x;
    size.y = place.y;
    size.width = size.min_width = size.max_width = place.width;
    size.height = size.min_height = size.max_height = place.height;
    size.win_gravity = StaticGravity;
    XWMHints manners{};
    manners.flags = InputHint;  // no keyboard for it
    manners.input = False;
    std::string name = "tileserver", kind = "WallGL";
    XClassHint program{name.data(), kind.data()};
    if (spec_.monitor.empty()) size.flags |= PMinSize | PMaxSize;
    XSetWMProperties(display, window_, nullptr, nullptr, nullptr, 0, &size, &manners, &program);
    XChangeProperty(display, window_, atom(display, "_NET_WM_NAME"), atom(display, "UTF8_STRING"), 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(title.data()), static_cast<int>(title.size()));

    // A close button, or its key, asks by a message that take() passes over, instead of ending the connection.
    Atom close = atom(display, "WM_DELETE_WINDOW");
    XSetWMProtocols(display, window_, &close, 1);
    constexpr unsigned long kDecorationsGiven = 2, kNone = 0;
    set_property(display, window_, "_MOTIF_WM_HINTS", atom(display, "_MOTIF_WM_HINTS"),
                 {kDecorationsGiven, 0, kNone, 0, 0});
    if (spec_.monitor.empty()) return;
    set_property(display, window_, "_NET_WM_STATE", XA_ATOM, {atom(display, "_NET_WM_STATE_FULLSCREEN")});
    set_property(display, window_, "_NET_WM_BYPASS_COMPOSITOR", XA_CARDINAL, {1});
}

void TileWindow::take(const _XEvent& event) {
    if (event.type == Expose) expose();
    if (event.type == DestroyNotify) gone_ = true;
    if (event.type != ConfigureNotify || (event.xconfigure.width == width() && event.xconfigure.height == height()))
        return;
    resize(event.xconfigure.width, event.xconfigure.height);
}

}  // namespace wall::tileserver
