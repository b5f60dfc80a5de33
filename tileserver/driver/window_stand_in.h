// SPDX-License-Identifier: MIT
// A window as large as the program's, whose pixels nobody sees, for what its size alone decides: where a vertex lies in
// it. It has attachments, of the smallest kind, because Mesa turns the raster position upside down by their height.
// Render thread.
#pragma once

#include "tileserver/driver/driver.h"

namespace wall::tileserver {

class WindowStandIn final : public RenderTarget {
public:
    /// Of so many pixels, 1:1 and whole. `driver` outlives it.
    WindowStandIn(Driver& driver, std::uint32_t width, std::uint32_t height);
    ~WindowStandIn();

    void bind(GLenum draw_buffer, GLenum read_buffer) override;
    bool draws_colors() const override { return false; }
    bool has_depth() const override { return false; }

private:
    Driver& driver_;
    GLuint pixels_ = 0;  // a renderbuffer, of which no memory is touched
};

}  // namespace wall::tileserver
