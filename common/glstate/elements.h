// SPDX-License-Identifier: MIT
// State elements by number: what the receiving side and other code without static types needs. Any thread; a State
// belongs to one at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gen/glstate/state.gen.h"
#include "gen/glstate/tables.gen.h"

namespace wall::glstate {

struct ElementInfo {
    const char* name;
    Category category;
    std::uint16_t id;  ///< of index 0
    std::uint16_t count;
    std::uint16_t bytes;       ///< of one value
    std::uint32_t offset;      ///< of index 0 in State
    GLbitfield groups;         ///< glPushAttrib's bits
    GLbitfield client_groups;  ///< glPushClientAttrib's bits
};

extern const std::array<ElementInfo, kElementCount> kElements;     ///< by first id
extern const std::array<std::uint16_t, kLastId + 1> kElementOfId;  ///< id -> index in kElements

/// The element that `id` (1 to kLastId) belongs to.
inline const ElementInfo& element_info(std::uint32_t id) { return kElements[kElementOfId[id]]; }

/// Where the value `id` lies in a state.
inline std::size_t element_offset(std::uint32_t id) {
    const ElementInfo& e = element_info(id);
    return e.offset + std::size_t{id - e.id} * e.bytes;
}

/// Size of a value that may travel; 0 = unknown id, or one that is not sent.
inline std::uint32_t element_bytes(std::uint32_t id) {
    return id == 0 || id > kLastSentId ? 0 : element_info(id).bytes;
}

/// Stores a value that has travelled. False: unknown id or wrong size. Values are not judged: what is wrong is the
/// driver's to refuse.
bool apply(State& state, std::uint32_t id, std::span<const std::byte> value);

}  // namespace wall::glstate
