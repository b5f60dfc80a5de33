// SPDX-License-Identifier: MIT
// Copies out of framebuffer objects, as those see them who draw such objects in parts (follow/drawn_parts.h): by
// glBlitFramebuffer, and what they have in common with draws that copy (sampled_parts.h). The application's thread.
#pragma once

#include <memory>

#include "client_lib/context/context.h"
#include "client_lib/objects/framebuffer.h"

namespace wall::client {

/// One blit.
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
    bool has_samples() const;
    bool makes_pixels() const;

    Context& c_;
    const std::shared_ptr<Framebuffer> read_, draw_;  ///< `draw_` null: the window
    CopiedOut::Place moved_;                          ///< where its first pixel comes
    bool is_plain_ = false;                           ///< all of it, as it is, to all of that or to the window
    bool ends_behind_ = false;                        ///< what is read from is drawn in parts until then
};

// ---- any copy of a target as it is, into what the context draws to ----

/// Where the target's first pixel comes, at (x, y).
CopiedOut::Place place_of_copy(const Context& c, GLint x, GLint y);
/// What the context draws to is the back buffer of its window.
bool draws_to_back_buffer(const Context& c);
/// The target is drawn in parts, and the copy takes no more than each node has: it is made as before.
bool goes_on(Context& c, DrawnTarget& copied, const CopiedOut::Place& to);
/// Behind it. From the habit on it is drawn in parts.
void note_copy(Context& c, const std::shared_ptr<DrawnTarget>& copied, const CopiedOut::Place& to);

/// Before all of the images of framebuffer objects may be needed on every node.
inline void want_whole_images(Context& c) {
    if (c.attached()) c.session().drawn_parts([&](DrawnParts& parts) { parts.end(c.share()); });
}

}  // namespace wall::client
