// SPDX-License-Identifier: MIT
// Content of objects that only nodes had (drawn content; DESIGN, section 4), read back from them before the program
// left their wall: as the commands that give it to a node. The first node of the other wall that needs an object gets
// them; further ones get it from that node, as ever. The session's mutex guards it.
#pragma once

#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/base/ids.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

struct KeptContent {
    wire::PackBuffer commands{0};
    std::vector<wire::PackMark> ends;  ///< of parts that are small enough to be sent one by one
};

class KeptContents {
public:
    void keep(ClientName object, KeptContent content) { by_object_.insert_or_assign(object, std::move(content)); }
    /// It is kept no longer.
    std::optional<KeptContent> take(ClientName object) {
        auto found = by_object_.extract(object);
        return found ? std::optional(std::move(found.mapped())) : std::nullopt;
    }
    void forget(ClientName object) { by_object_.erase(object); }
    void clear() { by_object_.clear(); }

private:
    std::unordered_map<ClientName, KeptContent> by_object_;
};

}  // namespace wall::client
