// SPDX-License-Identifier: MIT
// What transform feedback captures from its glBeginTransformFeedback to its end (OpenGL 3.0, 2.15). Every node of the
// session captures all of it, into its own copy of the buffers, so that what they hold then is drawn content: the
// draws go to a target that all nodes have and nobody sees (docs/programs.md). How many vertices there were, the nodes
// know; they keep it behind the end, for draws of as many (glDrawTransformFeedback). Belongs to one context; used by
// its thread, under the share group's mutex where other threads may look.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "client_lib/objects/buffer.h"
#include "client_lib/objects/drawn_target.h"
#include "client_lib/objects/framebuffer.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// Streams of vertices that a geometry shader may make.
inline constexpr unsigned kVertexStreams = glstate::el::captured_query::count;

/// Part of a buffer that values go to.
struct CapturedPart {
    std::shared_ptr<Buffer> buffer;       ///< null: no values go to this place
    std::uint32_t offset = 0, bytes = 0;  ///< bytes 0: as far as the buffer goes
};

class Capture final : public Object, public DrawnTarget {
public:
    /// `mode`: GL_POINTS, GL_LINES or GL_TRIANGLES.
    Capture(GLenum mode, std::vector<CapturedPart> parts);

    GLenum mode() const { return mode_; }
    const std::vector<CapturedPart>& parts() const { return parts_; }
    /// From now on nothing is captured any more.
    void end();

    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;
    /// Of one that has ended: its counts.
    bool is_drawn() const override { return ended_ && drawn_; }
    void pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>& packed) const override;

    ClientName target_id() const override { return framebuffer_->id; }
    std::uint32_t width() const override { return 1; }
    std::uint32_t height() const override { return 1; }
    /// The buffers.
    void for_each_image(const std::function<void(const Object&)>& use) const override;
    void note_drawn() override;
    /// Calls `use` with all that capturing needs, itself last.
    void for_each_used(const std::function<void(const Object&)>& use) const;
    /// What nobody needs behind the end.
    std::vector<ClientName> target_ids() const { return {framebuffer_->id, renderbuffer_->id}; }

private:
    const GLenum mode_;
    const std::vector<CapturedPart> parts_;
    std::uint64_t stamp_ = next_stamp();
    bool drawn_ = false, ended_ = false;
    std::shared_ptr<Renderbuffer> renderbuffer_ = std::make_shared<Renderbuffer>(0);
    std::shared_ptr<Framebuffer> framebuffer_ = std::make_shared<Framebuffer>(0);
};

}  // namespace wall::client
