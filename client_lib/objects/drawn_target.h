// SPDX-License-Identifier: MIT
// What is drawn to that is no window: a target made of objects, which every node of the session has and draws alike
// (DESIGN, section 4, "Drawn content": first step).
#pragma once

#include <cstdint>
#include <functional>

#include "client_lib/objects/object.h"

namespace wall::client {

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

protected:
    ~DrawnTarget() = default;
};

}  // namespace wall::client
