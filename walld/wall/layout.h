// SPDX-License-Identifier: MIT
// A layout: which window lies where on the wall, by the names of programs, so that it can be brought back another day.
// Rectangles are canvas pixels of the wall that it was saved on; another wall's are scaled. Pure.
//
//   {"version": 1, "canvas": [WIDTH, HEIGHT],
//    "windows": [{"name": "", "program": "glxgears", "title": "glxgears", "rect": [X, Y, W, H], "scaled": true}, ...]}
//    bottom first
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/geom/rect.h"
#include "walld/wall/refusal.h"

namespace wall::walld {

/// What people call a window.
struct WindowName {
    std::string name;  ///< the session's (WALLGL_NAME), may be empty
    std::string program;
    std::string title;
};

struct LayoutEntry {
    WindowName window;
    geom::Rect rect;
    bool scaled = true;  ///< false: as large as the program's window, and rect says where
    std::size_t z = 0;   ///< from the bottom
};

struct Layout {
    std::int32_t width = 0, height = 0;  ///< of the canvas
    std::vector<LayoutEntry> windows;    ///< bottom first
};

nlohmann::json layout_json(const Layout& layout);
std::string to_text(const Layout& layout);
Result<Layout> parse_layout(const std::string& text);
/// The same layout on a canvas of that size.
Layout scaled_to(Layout layout, std::int32_t width, std::int32_t height);

/// Takes the best place for a window out of `places`. With a name, an entry is for sessions of that name; without, for
/// windows of that program. Among several, the one of the same program and title, then the first.
std::optional<LayoutEntry> take_place(std::vector<LayoutEntry>& places, const WindowName& window);

/// Why nothing can lie there, if so: at least a pixel of it must be on the canvas.
Outcome<void> check_place(const geom::Rect& canvas, const geom::Rect& rect);

}  // namespace wall::walld
