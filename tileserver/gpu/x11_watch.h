// SPDX-License-Identifier: MIT
// Ends the process if the X server is gone and the render thread does not notice: Mesa 22.3 draws to a lost connection
// for ever (seen in xcb_put_image). Usually the render thread notices first, and ends in order.
#pragma once

#include <string>
#include <thread>

#include "common/base/unique_fd.h"

namespace wall::tileserver {

class X11Watch {
public:
    /// `connection` is the display's socket; it stays open as long as this lives. `message` is the last line on stderr.
    X11Watch(int connection, std::string message);
    ~X11Watch();
    X11Watch(const X11Watch&) = delete;

private:
    void run(int connection, const std::string& message) const;

    UniqueFd stop_;  // an eventfd
    std::thread thread_;
};

}  // namespace wall::tileserver
