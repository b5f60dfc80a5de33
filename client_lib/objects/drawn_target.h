// SPDX-License-Identifier: MIT
// What is drawn to that is no window: a target made of objects, which every node of the session has and draws alike
// (DESIGN, section 4, "Drawn content": first step).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include "client_lib/objects/copied_out.h"
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
    /// Whether each of its images is one of its own: no level, layer or view of a larger one. The share group's mutex
    /// is held.
    virtual bool has_plain_images() const { return false; }

    /// Whether they may have more pixels for a while without anybody's noticing: one sample each. The same.
    virtual bool may_be_larger() const { return false; }

    // ---- copies out of it. The thread that draws to it ----
    CopiedOut copied;
    /// That thread is the one that asks.
    bool is_drawn_here() const { return drawn_by_.load(std::memory_order_relaxed) == std::this_thread::get_id(); }

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
    void note_redrawn_here() {
        copied.note_redrawn();
        drawn_by_.store(std::this_thread::get_id(), std::memory_order_relaxed);
    }

private:
    std::atomic<std::thread::id> drawn_by_;
    std::shared_ptr<const ImageParts> kept_;  ///< also when they have ended: its thread may be looking at them
    std::atomic<const ImageParts*> parts_{nullptr};
    std::atomic<bool> ended_{false};
};

}  // namespace wall::client
