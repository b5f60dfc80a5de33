// SPDX-License-Identifier: MIT
// Transform feedback of a session: from its first draw on a transform feedback object of the driver that is active, and
// paused but while the session draws with it. Behind its end it knows how many vertices were captured. Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gen/glstate/state.gen.h"
#include "tileserver/driver/driver.h"
#include "tileserver/objects/object_table.h"
#include "tileserver/objects/query.h"

namespace wall::tileserver {

/// Buffers that values may go to at once.
inline constexpr std::size_t kMostCaptured = glstate::el::feedback_buffer::count;

class Capture final : public ObjectOf<ObjectKind::capture> {
public:
    using Counts = std::array<std::uint64_t, kVertexStreams>;

    Capture(ObjectAccount& account, Driver& driver) : ObjectOf(account), driver_(driver) {}
    ~Capture() override { release(); }

    /// Once. The parts are of the client's names; size 0: as far as the buffer goes. None: primitives are only counted.
    void define(GLenum mode, std::vector<glstate::BufferRange> parts);
    /// Instead: it is over, as another node has counted.
    void define_ended(const Counts& counts);
    bool defined() const { return defined_; }
    /// What the driver draws from now on is captured and not seen, until Driver::stop_capturing(). The program that is
    /// captured from is in use. False: more memory than a session may have.
    [[nodiscard]] bool go_on(const ObjectTable& objects);
    /// What counts the primitives that are captured now; null: nothing does.
    const std::shared_ptr<const DriverQuery>& counting(unsigned stream) const { return counting_[stream]; }
    /// Nothing is captured any more.
    void end();
    bool ended() const { return ended_; }
    /// How many vertices were captured of each stream; it has ended. Waits for the driver.
    const Counts& counts();

private:
    [[nodiscard]] GLuint begin(const ObjectTable& objects);
    void resume(const ObjectTable& objects);
    void end_bound(GLuint name);
    bool count();
    void release();

    Driver& driver_;
    GLuint name_ = 0;  // the driver's; 0: nothing was drawn yet, or it is over
    bool defined_ = false, ended_ = false, counted_ = false;
    GLenum mode_ = GL_POINTS;
    std::vector<glstate::BufferRange> parts_;
    std::array<QuerySum, kVertexStreams> primitives_;
    std::array<std::shared_ptr<const DriverQuery>, kVertexStreams> counting_;
    Counts counts_{};  // vertices; good if `counted_`
};

}  // namespace wall::tileserver
