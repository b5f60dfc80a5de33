// SPDX-License-Identifier: MIT
// What a stream draws of a window for other nodes (docs/sort-last.md): layers that lie as theirs do, each with a
// stencil buffer, whatever the window has. Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/base/ids.h"
#include "common/geom/rect.h"
#include "tileserver/driver/layer.h"

namespace wall::tileserver {

class SurfaceReplica;

class PartialLayers {
public:
    struct One {
        NodeIndex node;  ///< who shows it
        std::uint32_t slot = 0;
        geom::Rect area;     ///< window pixels, origin bottom left
        bool drawn = false;  ///< since it was empty
        std::unique_ptr<Layer> layer{};
    };

    /// Those of the window as it lies now; such as are there already keep their memory. False: over the budget.
    bool open(SurfaceReplica& surface, GLenum by, std::vector<One> wanted);
    std::vector<One>& all() { return all_; }
    /// How they will be, as PartialMerge says it.
    GLenum merged_by() const { return by_; }
    /// When that was last.
    std::chrono::steady_clock::time_point opened() const { return opened_; }
    /// To draw to. Null: there is none.
    Layer* draw_to(unsigned number);

private:
    std::vector<One> all_;
    GLenum by_ = GL_LESS;
    std::chrono::steady_clock::time_point opened_{};
};

}  // namespace wall::tileserver
