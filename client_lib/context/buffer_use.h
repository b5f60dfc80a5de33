// SPDX-License-Identifier: MIT
// The buffer objects that a context holds on to (buffer_binding.h has what is done with them). The application's
// thread.
#pragma once

#include <memory>
#include <unordered_map>

#include "client_lib/objects/buffer.h"
#include "common/base/ids.h"

namespace wall::client {

/// The buffers that a context's bindings and arrays may name, by id. Used by the context's thread.
struct BufferUse {
    std::unordered_map<ClientName, std::shared_ptr<Buffer>> by_id;
    std::uint64_t deletions = 0;  ///< ShareGroup::buffer_deletions when deleted ones were last let go
    bool holds_deleted = false;   ///< some were still named then
    BufferReading transfer;       ///< what the latest pixel command reads
};

}  // namespace wall::client
