// SPDX-License-Identifier: MIT
// The buffer objects that a context holds on to (buffer_binding.h has what is done with them). The application's
// thread.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "client_lib/objects/buffer.h"
#include "common/base/ids.h"

namespace wall::client {

/// Ids by the program's names of buffers that were bound lately: programs bind some for every draw. It holds until any
/// buffer of the share group is deleted.
class BoundLately {
public:
    /// 0: not known here.
    ClientName id_of(GLuint name) const {
        if (places_.empty()) return {};
        const Place& place = places_[name % kPlaces];
        return place.name == name ? place.id : ClientName();
    }
    void note(GLuint name, ClientName id) {
        if (places_.empty()) places_.resize(kPlaces);
        places_[name % kPlaces] = {name, id};
    }
    void forget() { places_.clear(); }

private:
    static constexpr std::size_t kPlaces = 4096;
    struct Place {
        GLuint name = 0;
        ClientName id;
    };
    std::vector<Place> places_;  ///< empty: nothing
};

/// The buffers that a context's bindings and arrays may name, by id. Used by the context's thread.
struct BufferUse {
    std::unordered_map<ClientName, std::shared_ptr<Buffer>> by_id;
    std::uint64_t deletions = 0;       ///< ShareGroup::buffer_deletions when deleted ones were last let go
    bool holds_deleted = false;        ///< some were still named then
    std::size_t calls_since_look = 0;  ///< at which deleted_buffers_are_due() has said no
    BoundLately bound_lately;
    BufferReading transfer;  ///< what the latest pixel command reads
};

}  // namespace wall::client
