// SPDX-License-Identifier: MIT
// Query objects of a context (OpenGL 3.3, 2.14). What is counted on nodes is a state element while it is current, so
// that every node knows what of its drawing counts. Application's thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "client_lib/follow/fence.h"
#include "client_lib/objects/capture.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

/// What can be current at once.
enum class QuerySlot : std::uint8_t {
    samples,     ///< of all targets about samples
    primitives,  ///< GL_PRIMITIVES_GENERATED
    captured,    ///< GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN
    time,        ///< GL_TIME_ELAPSED
    none,        ///< GL_TIMESTAMP, which is a moment
};
/// Of primitives there may be one for each stream of vertices.
inline constexpr bool by_stream(QuerySlot slot) { return slot == QuerySlot::primitives || slot == QuerySlot::captured; }

struct QueryObject {
    GLuint name = 0;
    GLenum target = 0;
    QuerySlot slot = QuerySlot::samples;
    GLuint stream = 0;
    ClientName id;  ///< on the wire; another one for each glBeginQuery
    bool answered = false;
    std::uint64_t result = 0;
    std::uint64_t place = 0;  ///< of its end among those of the context's queries
    // Until it is answered:
    bool asked = false;
    Fence counts;        ///< the nodes' answers, once they were asked
    Fence begun, ended;  ///< of times: what came before glBeginQuery, and glEndQuery or glQueryCounter
};

struct QueryState {
    NameTable<QueryObject> names;
    /// Of a slot and a stream; null: none.
    std::shared_ptr<QueryObject>& current(QuerySlot slot, GLuint stream) {
        return current_[static_cast<std::size_t>(slot)][by_stream(slot) ? stream : 0];
    }
    std::uint64_t ended = 0;    ///< queries so far
    std::uint64_t reached = 0;  ///< as many of them are known to be over on the nodes, which go in order
    bool conditional = false;   ///< between glBeginConditionalRender and glEndConditionalRender

private:
    static constexpr std::size_t kSlots = 4;
    std::array<std::array<std::shared_ptr<QueryObject>, kVertexStreams>, kSlots> current_;
};

}  // namespace wall::client
