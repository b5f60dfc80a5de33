// SPDX-License-Identifier: MIT
#include "client_lib/follow/hand_on.h"

#include <algorithm>
#include <utility>

#include "client_lib/follow/object_sender.h"

namespace wall::client {

void HandOn::bring_used(const NodeMasks& to, const DrawSource& source) {
    if (find_able(to, source, [&](Node& node) { return node.mirrors[source.id].used != source.used; }))
        source.objects.for_each_used([&](const Object& object) { bring(object); });
}

void HandOn::bring(const Object& object) {
    if (const Object* base = object.rests_on()) bring(*base);
    const std::uint64_t latest = object.latest();
    if (latest == 0 || object.is_drawn()) return;
    const std::uint64_t known = find_lacking(object);
    const bool asks = known == 0 && object.worth_asking();
    if (lacking_.size() >= 2 && asks) ask(object);
    else if (lacking_.size() < 2) return;
    object.pack_changes(known, packed_, [this] {
        if (packed_.bytes() >= kObjectBatchBytes) deliver();
    });
    if (asks) object.pack_shared(packed_);
    deliver();
    for (Node* node : lacking_) node->object_stamps[object.id] = latest;
}

std::uint64_t HandOn::find_lacking(const Object& object) {
    const auto known_to = [&](const Node& node) {
        const auto known = node.object_stamps.find(object.id);
        return known == node.object_stamps.end() ? 0 : known->second;
    };
    std::uint64_t best = 0;
    std::ptrdiff_t most = 0;
    const auto lacks = [&](const Node* node) {
        return known_to(*node) != object.latest() && !node->hollow.contains(object.id);
    };
    for (const Node* node : able_) {
        if (!lacks(node) || (most > 0 && known_to(*node) == best)) continue;
        const std::uint64_t known = known_to(*node);
        const auto alike =
            std::ranges::count_if(able_, [&](const Node* other) { return lacks(other) && known_to(*other) == known; });
        if (alike > most) best = known, most = alike;
    }
    lacking_.clear();
    for (Node* node : able_)
        if (lacks(node) && known_to(*node) == best) lacking_.push_back(node);
    return best;
}

void HandOn::ask(const Object& object) {
    std::erase_if(lacking_, [&](Node* node) {
        if (!may_be_asked(*node)) return true;
        const bool held = ObjectSender(nodes_, *node, nodes_.batch(*node, context_)).held(object);
        if (held) node->object_stamps[object.id] = object.latest();
        return held;
    });
}

void HandOn::deliver() {
    if (packed_.empty()) return;
    for (const Node* node : lacking_) count(*node, NodeCounter::object_bytes, packed_.bytes());
    if (lacking_.size() >= 2 && packed_.bytes() >= kLeastParcel && packed_.bytes() <= wire::kMostParcel / 2) {
        nodes_.hand_on(lacking_, context_, std::exchange(packed_, wire::PackBuffer()));
        return;
    }
    for (Node* node : lacking_) {
        wire::PackBuffer& batch = nodes_.batch(*node, context_);
        batch.append(packed_, {}, packed_.mark());
        if (batch.bytes() >= kObjectBatchBytes) nodes_.send(*node);
    }
    packed_.clear();
}

}  // namespace wall::client
