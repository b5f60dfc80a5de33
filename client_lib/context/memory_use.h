// SPDX-License-Identifier: MIT
// What the shaders of a context read and write at places that they address: images of textures, blocks of storage,
// atomic counters (OpenGL 4.2 and 4.3). Every node does all that writes, so that all hold the same (docs/programs.md).
// What is done with it: shader_memory.h. The context's thread.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "client_lib/objects/drawn_target.h"
#include "client_lib/objects/framebuffer.h"

namespace wall::client {

/// Where compute shaders run: a target that every node has and nobody sees, to which they draw nothing.
class DispatchTarget final : public DrawnTarget {
public:
    DispatchTarget();

    ClientName target_id() const override { return framebuffer_->id; }
    std::uint64_t stamp() const { return stamp_; }  ///< when it was made
    std::uint32_t width() const override { return 1; }
    std::uint32_t height() const override { return 1; }
    void for_each_image(const std::function<void(const Object&)>&) const override {}
    void note_drawn() override {}
    /// Calls `use` with what nodes need of it.
    void for_each_used(const std::function<void(const Object&)>& use) const;
    std::vector<ClientName> ids() const { return {framebuffer_->id, renderbuffer_->id}; }

private:
    const std::uint64_t stamp_ = next_stamp();
    std::shared_ptr<Renderbuffer> renderbuffer_ = std::make_shared<Renderbuffer>(0);
    std::shared_ptr<Framebuffer> framebuffer_ = std::make_shared<Framebuffer>(0);
};

/// What every node does with images at once, whatever is drawn with: copies of texels, mipmaps of a view.
struct ImageWork {
    std::vector<std::shared_ptr<const Object>> used;
    const Object* written = nullptr;   ///< one of them, or what keeps its texels
    std::function<void()> note_drawn;  ///< the share group's mutex is held
};

struct MemoryUse {
    bool any = false;                        ///< something was ever bound
    std::unique_ptr<DispatchTarget> target;  ///< null: nothing was dispatched yet
    DispatchTarget* now = nullptr;           ///< what is sent now is for it
    const ImageWork* work = nullptr;         ///< and is this, not what the context's program does
};

}  // namespace wall::client
