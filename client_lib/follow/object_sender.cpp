// SPDX-License-Identifier: MIT
#include "client_lib/follow/object_sender.h"

#include <utility>

#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

constexpr std::size_t kObjectBatchBytes = std::size_t{4} << 20;  // a batch of objects is sent when it reaches this
constexpr int kQuestionLimitMs = 1500;  // the node may be waiting for another program that is sending this very content

/// Whether an answer can be expected soon.
bool may_be_asked(const Node& node) { return node.answers() && !node.slow && !node.asks_unanswered; }

}  // namespace

void ObjectSender::send(const Object& object) {
    const std::uint64_t latest = object.latest();
    if (latest == 0) return;
    const std::uint64_t known = std::exchange(node_.object_stamps[object.id], latest);
    if (known == latest) return;
    const bool asks = known == 0 && object.worth_asking() && may_be_asked(node_);
    if (asks && held(object)) return;
    object.pack_changes(known, buffer_, [this] {  // a node at time zero may need more than a frame holds
        if (buffer_.bytes() >= kObjectBatchBytes) send_off();
    });
    if (asks && object.pack_shared(buffer_)) send_off();  // others may be waiting for it
}

/// One short round trip, for which the session's mutex stays taken. True: the node has the object now. False: send it;
/// the node then keeps it for others, too, whether its answer was that or came too late.
bool ObjectSender::held(const Object& object) {
    const auto pack = [&](wire::PackBuffer& batch, RequestId request) {
        object.pack_question(batch, request);
        sent_ += batch.bytes() - start_;
        start_ = 0;  // it goes out
    };
    const auto answer = nodes_.ask_now(node_, "global share", kQuestionLimitMs, pack);
    node_.asks_unanswered = !answer || answer->empty();
    return !node_.asks_unanswered && answer->front() != std::byte{0};
}

void ObjectSender::send_off() {
    sent_ += buffer_.bytes() - start_;
    nodes_.send(node_);
    start_ = buffer_.bytes();
}

std::size_t bring_up_to_date(Nodes& nodes, Node& node, const DrawSource& source, wire::PackBuffer& buffer) {
    Mirror& mirror = node.mirrors[source.id];
    if (mirror.used == source.used) return 0;
    ObjectSender sender(nodes, node, buffer);
    source.objects.for_each_used([&](const Object& object) { sender.send(object); });
    mirror.used = source.used;
    return sender.bytes();
}

void note_used(Node& follower, Mirror& mirror, const DrawSource& source, wire::PackBuffer& buffer) {
    if (mirror.used == source.used) return;
    source.objects.for_each_used([&](const Object& object) {
        auto& known = follower.object_stamps[object.id];
        object.pack_values(known, buffer);
        known = object.latest();
    });
    mirror.used = source.used;
}

void bring_noted(Nodes& nodes, Node& node, ShareGroup& share, const ObjectStamps& noted, wire::PackBuffer& buffer) {
    std::lock_guard lock(share.mutex);
    ObjectSender sender(nodes, node, buffer);
    for (const auto& [id, stamp] : noted) {
        const auto found = share.by_id.find(id);
        if (found == share.by_id.end() || found->second->latest() == 0) continue;
        sender.send(*found->second);
        node.object_stamps[id] = found->second->defined();
    }
    count(node, NodeCounter::object_bytes, sender.bytes());
}

}  // namespace wall::client
