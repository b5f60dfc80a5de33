// SPDX-License-Identifier: MIT
#include "client_lib/objects/object.h"

#include <atomic>

#include "client_lib/link/parallel.h"
#include "common/wire/limits.h"

namespace wall::client {

std::uint64_t next_stamp() {
    static std::atomic<std::uint64_t> last{0};
    return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

namespace {

std::uint32_t next_number() {
    static std::atomic<std::uint32_t> last{parallel() ? wire::kMaxSharedSurfaces : 0};
    return ++last;
}

}  // namespace

ContextId next_context_id() { return ContextId(next_number()); }
SurfaceId next_surface_id() { return SurfaceId(next_number()); }
ClientName next_object_id() { return ClientName(next_number()); }

}  // namespace wall::client
