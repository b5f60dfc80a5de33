// SPDX-License-Identifier: MIT
#include "client_lib/follow/object_sender.h"

#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "client_lib/objects/share_group.h"
#include "client_lib/process/log.h"

namespace wall::client {
namespace {

constexpr int kDrawnLimitMs = 5000;     // a node answers behind all that it has to draw before
constexpr int kQuestionLimitMs = 1500;  // the node may be waiting for another program that is sending this very content

/// Packs the object's drawn content, as the node has it. False: the node does not answer.
bool ask_drawn(Nodes& nodes, Node& holder, const Object& object, wire::PackBuffer& out,
               const std::function<void()>& packed) {
    bool answered = true;
    const auto ask = [&](const auto& pack, const ImageRows&) -> std::optional<std::vector<std::byte>> {
        if (!answered) return std::nullopt;
        auto answer = nodes.ask_now(holder, "drawn content", kDrawnLimitMs, pack);
        answered = answer.has_value();
        return answer;
    };
    object.pack_drawn(ask, out, packed);
    if (!answered) holder.slow = true;  // until it answers to a frame
    return answered;
}

bool keep_drawn(Nodes& nodes, Node& holder, const Object& object) {
    ObjectSender(nodes, holder, holder.batch).send(object);  // what was changed since it was drawn
    KeptContent kept;
    const auto end_part = [&] { kept.ends.push_back(kept.commands.mark()); };
    if (!ask_drawn(nodes, holder, object, kept.commands, end_part)) return false;
    end_part();
    nodes.kept().keep(object.id, std::move(kept));
    return true;
}

/// What is drawn now the node does not draw.
void lose_images(Nodes& nodes, Node& node, const DrawSource& source) {
    nodes.note_change();
    std::lock_guard lock(source.share->mutex);
    const auto lose = [&](const Object& image) {
        if (const auto known = node.object_stamps.find(image.id); known != node.object_stamps.end()) known->second = 0;
        node.hollow.erase(image.id);
    };
    source.draw.for_each_image(lose);
    source.objects.for_each_written(lose);
    for (auto& [context, mirror] : node.mirrors) mirror.used = {};
}

}  // namespace

void ObjectSender::send(const Object& object) {
    if (const Object* base = object.rests_on()) send(*base);
    const std::uint64_t latest = object.latest();
    if (latest == 0) return;
    const std::uint64_t known = std::exchange(node_.object_stamps[object.id], latest);
    const bool hollow = !node_.hollow.empty() && node_.hollow.contains(object.id);
    if (known == latest && !hollow) return;
    const bool asks = known == 0 && object.worth_asking() && may_be_asked(node_);
    if (asks && held(object)) return;
    if (known != latest)
        object.pack_changes(known, buffer_, [this] {  // a node at time zero may need more than a frame holds
            if (buffer_.bytes() >= kObjectBatchBytes) send_off();
        });
    if (!object.is_drawn()) node_.hollow.erase(object.id);
    else if (known == 0 || hollow) fetch(object, hollow);
    if (asks && object.pack_shared(buffer_)) send_off();  // others may be waiting for it
}

/// From any node that has the object. One that goes away meanwhile, or is too busy to answer, is no reason to go
/// without: the next one is asked, and those that do not answer now with a later draw; `again`, and no slow one then,
/// as that would hold up draw after draw. If nobody has it, the program has to draw it again.
void ObjectSender::fetch(const Object& object, bool again) {
    bool later = false;
    node_.hollow.insert(object.id);
    for (const auto& holder : nodes_) {
        if (holder.get() == &node_ || holder->records() || !holder->alive() || !holder->holds(object.id)) continue;
        if (holder->answers() && !(again && holder->slow) && fetch_from(*holder, object)) {
            node_.hollow.erase(object.id);
            return;
        }
        later = later || holder->alive();
    }
    if (later) return;
    node_.hollow.erase(object.id);
    if (send_kept(object)) return;
    log(LogLevel::warn, "event=drawn_content_lost object=%u", object.id.value);
}

bool ObjectSender::fetch_from(Node& holder, const Object& object) {
    ObjectSender(nodes_, holder, holder.batch).send(object);  // what was changed since it was drawn
    return ask_drawn(nodes_, holder, object, buffer_, [this] {
        if (buffer_.bytes() >= kObjectBatchBytes) send_off();
    });
}

bool ObjectSender::send_kept(const Object& object) {
    const auto kept = nodes_.kept().take(object.id);
    if (!kept) return false;
    wire::PackMark first;
    for (const wire::PackMark& end : kept->ends) {
        buffer_.append(kept->commands, first, end);
        first = end;
        if (buffer_.bytes() >= kObjectBatchBytes) send_off();
    }
    return true;
}

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

void bring_drawn(Nodes& nodes, const DrawSource& source) {
    for (const TargetLayer& layer : source.draw.layers()) {
        Node& node = nodes[layer];
        if (!node.alive()) continue;
        if (!source.draw.goes_to(node)) {
            if (source.draw.of_objects() || source.objects.writes()) lose_images(nodes, node, source);
            continue;
        }
        if (node.mirrors[source.id].used == source.used) continue;
        ObjectSender sender(nodes, node, nodes.batch(node, source.id));
        source.objects.for_each_used([&](const Object& object) {
            if (object.is_drawn() && !node.holds(object.id)) sender.send(object);
        });
        count(node, NodeCounter::object_bytes, sender.bytes());
    }
}

std::size_t bring_up_to_date(Nodes& nodes, Node& node, Mirror& mirror, const DrawSource& source,
                             wire::PackBuffer& buffer) {
    if (mirror.used == source.used) return 0;
    ObjectSender sender(nodes, node, buffer);
    source.objects.for_each_used([&](const Object& object) { sender.send(object); });
    if (node.hollow.empty()) mirror.used = source.used;
    return sender.bytes();
}

void keep_drawn(Nodes& nodes) {
    for_each_share_group([&](ShareGroup& share) {
        std::lock_guard lock(share.mutex);
        for (const auto& [id, object] : share.by_id) {
            if (!object->is_drawn()) continue;
            for (const auto& holder : nodes)
                if (holder->answers() && holder->holds(id) && keep_drawn(nodes, *holder, *object)) break;
        }
    });
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
