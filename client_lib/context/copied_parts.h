// SPDX-License-Identifier: MIT
// Copies out of framebuffer objects (glBlitFramebuffer), as those see them who draw such objects in parts
// (follow/drawn_parts.h). The application's thread.
#pragma once

#include <memory>

#include "client_lib/context/context.h"
#include "client_lib/objects/framebuffer.h"

namespace wall::client {

/// One copy.
class CopyOfParts {
public:
    /// Window pixels; x1 and y1 are past the end, and below x0 and y0 where it is mirrored.
    struct Corners {
        GLint x0, y0, x1, y1;
    };
    /// Before its command is packed. What is read from is a framebuffer object.
    CopyOfParts(Context& c, const Corners& from, const Corners& to, GLbitfield mask);
    CopyOfParts(const CopyOfParts&) = delete;
    /// Behind it.
    void finish();

private:
    bool takes_all(const Corners& from) const;
    bool comes_to_all(const Corners& to) const;
    bool makes_pixels() const;
    bool goes_on();
    void note_habit();

    Context& c_;
    const std::shared_ptr<Framebuffer> read_, draw_;  ///< `draw_` null: the window
    CopiedOut::Place moved_;                          ///< where its first pixel comes
    bool is_plain_ = false;                           ///< all of it, as it is, to all of that or to the window
    bool ends_behind_ = false;                        ///< what is read from is drawn in parts until then
};

/// Before all of the images of framebuffer objects may be needed on every node.
inline void want_whole_images(Context& c) {
    if (c.attached()) c.session().drawn_parts([&](DrawnParts& parts) { parts.end(c.share()); });
}

}  // namespace wall::client
