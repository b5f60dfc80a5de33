// SPDX-License-Identifier: MIT
// A context's buffers for staged draws (staged_draw.h), by the place of the array (InputArray::place). The context
// names them like any other (BufferUse::by_id), but the program has no name for them. The context's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>

#include "client_lib/objects/buffer.h"

namespace wall::client {

struct StagingBuffers {
    std::unordered_map<std::uint32_t, std::shared_ptr<Buffer>> by_place;
};

}  // namespace wall::client
