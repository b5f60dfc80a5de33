// SPDX-License-Identifier: MIT
// Draws that bring to the window, as it is, what was drawn in a framebuffer object: they look its texture up where each
// fragment lies, as toolkits do with the pictures of their widgets. Whether a draw is such a one follows from its
// program (glapi::TextureLookup) and its few vertices, and then it is a copy like a blit: the object can be drawn in
// parts (follow/drawn_parts.h). The application's thread.
#pragma once

#include <memory>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/context/copied_parts.h"
#include "client_lib/context/node_draw.h"

namespace wall::client {

/// One draw.
class DrawOfParts {
public:
    /// Before anything of it is packed, if may_copy(). It is as it will be drawn.
    DrawOfParts(Context& c, const ArrayDraw& draw);
    DrawOfParts(const DrawOfParts&) = delete;
    /// Behind it.
    void finish();

    /// Whether it is worth a closer look.
    static bool may_copy(const Context& c, const ArrayDraw& draw);

private:
    /// An image that it looks up.
    struct Image {
        std::size_t lookup;  ///< in the program
        std::shared_ptr<Texture> texture;
        std::shared_ptr<DrawnTarget> target;  ///< that it was drawn as an image of, by this thread
        CopiedOut::Place to;
    };
    void find_images();
    void find_places(const ArrayDraw& draw);
    void allow();

    Context& c_;
    std::vector<Image> images_;  ///< that are copied as they are
    bool allowed_ = false;       ///< some of them are drawn in parts, and may stay so
};

}  // namespace wall::client
