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
    /// Its images are of that size from now on, with what they hold scaled, while those who draw to it know nothing of
    /// it: like a layer of a window that is shown larger. Where the driver or the session's memory does not let one of
    /// them, they stay as they are.
    void enlarge(const ObjectTable& objects, SharedContents& shared, std::int32_t width, std::int32_t height);
    /// They are as they were before.
    void restore(const ObjectTable& objects, SharedContents& shared);

    void bind(GLenum draw_buffer, GLenum read_buffer) override;
    bool draws_colors() const override;
    bool has_depth() const override { return has_depth_; }

private:
    void set_buffers();
    void set_defaults();
    void detach_all();
    Result<void> attach(GLuint to, const glstate::FramebufferAttachment& attachment, const ObjectTable& objects,
                        SharedContents& shared);
    Result<void> attach_all(GLuint to, const ObjectTable& objects, SharedContents& shared);
    template <class Use>
    bool all_images(const ObjectTable& objects, Use&& use);
    void restore_images(const ObjectTable& objects);
    void copy_images(GLuint from, const LayerGeometry& as);
    void find_size();

    Driver& driver_;
    const Gl& gl_;
    glstate::FramebufferDefinition definition_;
    std::optional<geom::Rect> part_;
    std::optional<LayerGeometry> own_;  // while it is enlarged: as it was before
    bool has_depth_ = false;
    bool defined_ = false;                            // anew, since update()
    std::uint64_t textures_ = 0, renderbuffers_ = 0;  // versions of the table as of update()
};

}  // namespace wall::tileserver
