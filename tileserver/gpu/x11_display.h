// SPDX-License-Identifier: MIT
// The connection to the X server whose monitors show tiles. Xlib's headers stay out of this one: their macros meet
// everybody's names. Render thread.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/geom/rect.h"
#include "tileserver/gpu/x11_watch.h"

struct _XDisplay;

namespace wall::tileserver {

class X11Display {
public:
    /// `name` as in DISPLAY; empty: what DISPLAY says. The error names the remedy.
    static Result<std::unique_ptr<X11Display>> open(const std::string& name);
    ~X11Display();
    X11Display(const X11Display&) = delete;
    X11Display& operator=(const X11Display&) = delete;

    _XDisplay* get() const { return display_; }
    const std::string& name() const { return name_; }
    /// In pixels of the X screen. An unknown name is an error that lists the monitors there are.
    Result<geom::Rect> monitor(const std::string& name) const;
    /// Of the fastest monitor that is on; of 60 Hz if the server does not say.
    std::chrono::nanoseconds refresh_period() const;
    /// No blanking and no power saving as long as the connection lives, where the server can do that.
    void suspend_screen_saver() const;
    /// Waits until the server has done everything; what it refused since the last call is an error.
    Result<void> check_requests(const std::string& what) const;
    /// The server has gone away. Calls of Xlib do nothing from then on.
    bool lost() const { return lost_; }

private:
    explicit X11Display(std::string name) : name_(std::move(name)) {}
    std::string gone() const;

    std::string name_;
    _XDisplay* display_ = nullptr;
    bool lost_ = false;
    std::optional<X11Watch> watch_;
};

}  // namespace wall::tileserver
