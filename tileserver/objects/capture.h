// SPDX-License-Identifier: MIT
// Transform feedback of a session: from its first draw on a transform feedback object of the driver that is active, and
// paused but while the session draws with it. Render thread.
#pragma once

#include <vector>

#include "gen/glstate/state.gen.h"
#include "tileserver/driver/driver.h"
#include "tileserver/objects/object_table.h"

namespace wall::tileserver {

/// Buffers that values may go to at once.
inline constexpr std::size_t kMostCaptured = glstate::el::feedback_buffer::count;

class Capture final : public ObjectOf<ObjectKind::capture> {
public:
    Capture(ObjectAccount& account, Driver& driver) : ObjectOf(account), driver_(driver) {}
    ~Capture() override;

    /// Once. The parts are of the client's names; size 0: as far as the buffer goes. None: primitives are only counted.
    void define(GLenum mode, std::vector<glstate::BufferRange> parts);
    bool defined() const { return defined_; }
    /// What the driver draws from now on is captured and not seen, until Driver::stop_capturing(). The program that is
    /// captured from is in use.
    void go_on(const ObjectTable& objects);

private:
    void begin(const ObjectTable& objects);

    Driver& driver_;
    GLuint name_ = 0;  // the driver's; 0: nothing was drawn yet
    bool defined_ = false;
    GLenum mode_ = GL_POINTS;
    std::vector<glstate::BufferRange> parts_;
};

}  // namespace wall::tileserver
