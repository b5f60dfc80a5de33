// SPDX-License-Identifier: MIT
// Draws whose instances are not counted from 0 (OpenGL 4.2, 2.8.3): arrays that go on from instance to instance begin
// at a later element; gl_InstanceID does not know of it. The context's thread.
#pragma once

#include <cstdint>

#include "gen/glstate/state.gen.h"

namespace wall::client {

/// While it lives, such arrays of the state begin `base` elements later.
class BasedInstances {
public:
    BasedInstances(glstate::State& state, std::uint32_t base);
    ~BasedInstances();
    BasedInstances(const BasedInstances&) = delete;

private:
    glstate::State& state_;
    const glstate::VertexArraysState arrays_;
    const std::uint64_t values_;
};

}  // namespace wall::client
