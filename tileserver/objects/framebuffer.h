// SPDX-License-Identifier: MIT
// A framebuffer object of a session: a target like a layer of a window, but with its pixels at their own places and
// with images of the session's textures and renderbuffers. Render thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/result.h"
#include "common/glstate/framebuffer.h"
#include "tileserver/driver/driver.h"
#include "tileserver/objects/object_table.h"
#include "tileserver/objects/shared_content.h"

namespace wall::tileserver {

class Framebuffer final : public ObjectOf<ObjectKind::framebuffer>, public RenderTarget {
public:
    Framebuffer(ObjectAccount& account, Driver& driver);
    ~Framebuffer() override;

    void define(const glstate::FramebufferDefinition& definition);
    /// Before it is used: its images as the session has them now. They are the session's own from here on, not `shared`
    /// with others any more. An error: an attachment is of another kind than its definition says, or copies take more
    /// memory than a session may have.
    Result<void> update(const ObjectTable& objects, SharedContents& shared);
    /// From now on only these pixels of its images change, y up; none: all.
    void draw_part(const std::optional<geom::Rect>& part);

    void bind(GLenum draw_buffer, GLenum read_buffer) override;
    bool draws_colors() const override;
    bool has_depth() const override { return has_depth_; }

private:
    void set_defaults();
    void detach_all();
    Result<void> attach(const glstate::FramebufferAttachment& attachment, const ObjectTable& objects,
                        SharedContents& shared);
    void find_size();

    Driver& driver_;
    const Gl& gl_;
    glstate::FramebufferDefinition definition_;
    std::optional<geom::Rect> part_;
    bool has_depth_ = false;
    bool defined_ = false;                            // anew, since update()
    std::uint64_t textures_ = 0, renderbuffers_ = 0;  // versions of the table as of update()
};

}  // namespace wall::tileserver
