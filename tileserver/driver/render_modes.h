// SPDX-License-Identifier: MIT
// glRenderMode of one session. Selection and feedback are modes of the driver's one context; a session has it in the
// mode only while its own blocks are drawn: enter() before one, leave() when others may draw. What has been found
// until then is kept here, so that the program sees one selection however often it was left. Render thread.
//
// Feedback: values of the parts follow one another. Selection: the driver's name stack has one name, the number of an
// epoch (the time between two commands of the program's name stack); the program's stack is kept here. A hit of the
// driver is then an epoch and a range of depths, and two of one epoch, from before and after a leave(), are one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

class RenderModes {
public:
    explicit RenderModes(const Gl& gl) : gl_(gl) {}
    ~RenderModes() { leave(); }
    RenderModes(const RenderModes&) = delete;

    GLenum mode() const { return mode_; }
    /// Ends the mode and begins another one, whose results may take `entries` values. What RenderMode is answered with:
    /// the result of the mode that ended (-1: its buffer was too small), then the content of its buffer.
    std::vector<std::byte> change(GLenum mode, GLenum feedback_type, std::uint32_t entries);

    /// The driver has the mode from here on.
    void enter();
    void leave();

    // Between enter() and leave(); as the commands of these names, but for errors, which change nothing.
    void init_names();
    void load_name(GLuint name);
    void push_name(GLuint name);
    void pop_name();

private:
    using Names = std::vector<GLuint>;
    struct Hit {
        Names names;
        GLuint nearest = 0, farthest = 0;
    };
    void begin_epoch();
    void collect_hits(GLint hits);
    void write_hit(const Hit& hit);
    void write(GLuint value);
    std::int32_t end_selection();
    std::int32_t end_feedback();

    const Gl& gl_;
    GLenum mode_ = GL_RENDER;
    bool entered_ = false;

    // Selection.
    std::vector<GLuint> selection_;  // the program's buffer
    std::size_t written_ = 0;        // values that it would hold if it were large enough
    std::int32_t hits_ = 0;
    Names names_;                      // the program's stack
    std::vector<Names> epochs_;        // since enter()
    std::vector<GLuint> driver_hits_;  // the driver's buffer
    std::optional<Hit> open_;          // of the last epoch, which may go on
    bool goes_on_ = false;             // the first epoch since enter() is the last one of before

    // Feedback.
    std::vector<GLfloat> feedback_;  // one value longer than the program's: Mesa knows no buffer without any
    std::size_t used_ = 0;
    GLenum feedback_type_ = GL_2D;
};

}  // namespace wall::tileserver
