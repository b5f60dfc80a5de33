// SPDX-License-Identifier: MIT
// A window of which there are no pixels, for what its size alone decides: where a vertex lies in it. Render thread.
#pragma once

#include "tileserver/driver/driver.h"

namespace wall::tileserver {

class PixellessTarget final : public RenderTarget {
public:
    /// Of so many pixels, 1:1 and whole. `driver` outlives it.
    PixellessTarget(Driver& driver, std::uint32_t width, std::uint32_t height);
    ~PixellessTarget();

    void bind(GLenum draw_buffer, GLenum read_buffer) override;
    bool draws_colors() const override { return false; }

private:
    Driver& driver_;
};

}  // namespace wall::tileserver
