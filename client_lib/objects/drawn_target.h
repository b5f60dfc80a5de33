// SPDX-License-Identifier: MIT
// What is drawn to that is no window: a target made of objects, which every node of the session has and draws alike
// (DESIGN, section 4, "Drawn content": first step).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "client_lib/objects/object.h"

namespace wall::client {

struct ImageParts;  // follow/image_parts.h

class DrawnTarget {
public:
    /// By which nodes know it.
    virtual ClientName target_id() const = 0;
    /// Pixels.
    virtual std::uint32_t width() const = 0;
    virtual std::uint32_t height() const = 0;
    /// The objects whose images it draws to. The share group's mutex is held.
    virtual void for_each_image(const std::function<void(const Object&)>& use) const = 0;
    /// What its images hold is on the nodes only from now on. The share group's mutex is held.
    virtual void note_drawn() = 0;
    /// Stamp of its definition: which images, and how.
    virtual std::uint64_t defined() const { return 0; }

    // ---- second step: each node its part (follow/drawn_parts.h). The session's mutex is held ----
    /// Null: every node draws all of it. The thread that draws to it needs no mutex.
    const ImageParts* parts() const { return parts_.load(std::memory_order_acquire); }
    /// By the thread that draws to it.
    void draw_parts(std::shared_ptr<const ImageParts> parts) {
        kept_ = std::move(parts);
        parts_.store(kept_.get(), std::memory_order_release);
    }
    void draw_whole() {
        parts_.store(nullptr, std::memory_order_release);
        ended_.store(true, std::memory_order_relaxed);
    }
    /// Whether they have ended since this was asked last.
    bool take_ended() { return ended_.exchange(false, std::memory_order_relaxed); }

protected:
    ~DrawnTarget() = default;

private:
    std::shared_ptr<const ImageParts> kept_;  ///< also when they have ended: its thread may be looking at them
    std::atomic<const ImageParts*> parts_{nullptr};
    std::atomic<bool> ended_{false};
};

}  // namespace wall::client
