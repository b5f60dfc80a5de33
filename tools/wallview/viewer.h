// SPDX-License-Identifier: MIT
// wallview: a stream in a window of the desktop (a display node, A3.4). The main thread has the window; LiveView's
// receives and decodes.
#pragma once

#include "tools/view/live_view.h"
#include "tools/wallview/window.h"

namespace wall::wallview {

struct Options {
    nlohmann::json what;  ///< an entry of a watch list, without a size
    std::string title;    ///< of what is seen
    Window::Size size;    ///< of the window
    bool fullscreen = false;
    std::uint64_t frames = 0;  ///< complete pictures, then it ends; 0: until somebody ends it
    std::string save;          ///< the last picture goes there in the end
};

/// Runs until somebody ends it. With `frames`, a failure before the first picture is an error; else it is tried again.
Result<void> run(const view::LiveView::Connect& connect, const Options& options);

}  // namespace wall::wallview
