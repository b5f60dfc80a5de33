// SPDX-License-Identifier: MIT
// One tileserver as a process sees it: the stream to it, and a mirror of what it holds. Every node is a follower of the
// process's contexts, some logical time behind (DESIGN, section 1). The session's mutex guards it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "client_lib/link/connect_attempt.h"
#include "client_lib/link/control_messages.h"
#include "client_lib/link/node_stream.h"
#include "client_lib/link/reopening.h"
#include "client_lib/objects/object.h"
#include "client_lib/process/stats.h"
#include "common/base/ids.h"
#include "common/glstate/value_history.h"
#include "common/wire/pack_buffer.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// Logical times, by object.
using ObjectStamps = std::unordered_map<ClientName, std::uint64_t>;

/// Which objects, together, a node was brought as of which stamp, by the id of one of them that stands for all: a look
/// here instead of one at each. A place may be taken by another, and then the objects themselves tell.
class BroughtTogether {
public:
    bool has(ClientName id, std::uint64_t stamp) const {
        if (places_.empty()) return false;
        const Place& place = places_[id.value % kPlaces];
        return place.id == id && place.stamp == stamp;
    }
    void note(ClientName id, std::uint64_t stamp) {
        if (places_.empty()) places_.resize(kPlaces);
        places_[id.value % kPlaces] = {id, stamp};
    }
    void forget() { places_.clear(); }

private:
    static constexpr std::size_t kPlaces = 4096;
    struct Place {
        ClientName id;
        std::uint64_t stamp = 0;
    };
    std::vector<Place> places_;  ///< empty: nothing
};

/// What a node holds of one context.
struct Mirror {
    glstate::State state;
    glstate::ValueHistory history;
    SurfaceId draw_surface, read_surface;
    /// Targets made of objects, instead of surfaces.
    struct Objects {
        ClientName draw, read;
        bool counts = true;  ///< samples
        bool operator==(const Objects&) const = default;
    };
    Objects targets;
    UseStamp used;  ///< as of when the node was last brought what drawing with the context needs
};

/// One tileserver as this process sees it.
struct Node {
    NodeIndex index;
    std::string name;
    NodeInfo info;
    std::shared_ptr<NodeStream> stream;                     ///< null: not connected
    std::unordered_map<ContextId, Mirror> mirrors;          ///< by context
    ObjectStamps object_stamps;                             ///< of what the node has; absent: nothing
    std::unordered_set<ClientName> hollow;                  ///< has them without what was drawn in them: see fetch()
    BroughtTogether brought;                                ///< vertex inputs with their buffers
    std::unordered_map<SurfaceId, std::uint32_t> surfaces;  ///< by surface: layout version it knows
    std::unordered_map<SurfaceId, std::uint32_t>
        left_out;                             ///< surfaces whose frames it does not get now: the last one it got
    bool asks_unanswered = false;             ///< a question about content took too long: it gets no more
    bool slow = false;                        ///< missed a frame's limit; not waited for until it answers again
    std::shared_ptr<ConnectAttempt> attempt;  ///< one that is being made
    Reopening reopening;

    std::vector<std::uint32_t> held_semaphores;  ///< that it must take before anything else than what was dealt to it
    wire::PackBuffer batch;                      ///< being packed
    ContextId batch_context;                     ///< whose
    std::uint64_t batches = 0;                   ///< that were before it

    bool alive() const { return stream && !stream->failed(); }
    /// It keeps what comes in a file: it has no tile, and nothing is asked of it.
    bool records() const { return info.records; }
    /// Whether it can be expected to answer soon.
    bool answers() const { return alive() && left_out.empty() && !records(); }
    /// Whether it has all that it was brought of the object, and what was drawn in it, too.
    bool holds(ClientName object) const {
        const auto known = object_stamps.find(object);
        return known != object_stamps.end() && known->second != 0 && !hollow.contains(object);
    }
};

/// Adds to what the statistics know of the node.
inline void count(const Node& node, NodeCounter counter, std::size_t amount) {
    if (amount != 0) stats().add_node(node.index, counter, amount);
}

}  // namespace wall::client
