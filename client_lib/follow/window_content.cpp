// SPDX-License-Identifier: MIT
#include "client_lib/follow/window_content.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "client_lib/follow/dealer.h"
#include "client_lib/follow/open_block.h"
#include "client_lib/objects/object.h"
#include "client_lib/process/log.h"
#include "common/glstate/pack_sink.h"
#include "common/wire/limits.h"

namespace wall::client {
namespace {

constexpr int kAnswerLimitMs = 5000;  // a node answers behind all that it has to draw before
constexpr std::int64_t kPixelBytes = 4;

struct ImageFormat {
    GLenum format, type;
};
constexpr ImageFormat kColors{GL_RGBA, GL_UNSIGNED_BYTE};

/// Of a window that has depths.
ImageFormat depth_format(const SurfaceFormat& format) {
    if (format.stencil_bits == 0) return {GL_DEPTH_COMPONENT, GL_UNSIGNED_INT};
    return {GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8};
}

template <class Element>
void pack_value(wire::PackBuffer& buffer, const typename Element::type& value) {
    glapi::pack_state(buffer, Element::id, &value, sizeof value);
}

void pack_plane(wire::PackBuffer& buffer, std::uint64_t slots, const geom::Rect& area, const ImageFormat& format,
                std::span<const std::byte> pixels) {
    const OpenBlock block = begin_block(buffer, slots);
    glapi::pack::WindowContent(buffer, area.x, area.y, area.width, area.height, format.format, format.type, pixels);
    end_block(buffer, block);
}

/// The layers of the target that a node has and that show a part of the program's own picture.
std::uint64_t plain_slots(const DrawTarget& target, NodeIndex node) {
    std::uint64_t slots = 0;
    for (const TargetLayer& layer : target.layers())
        if (layer.node == node && layer.view == 0) slots |= layer.bit();
    return slots;
}

bool contains(const geom::Rect& outer, const geom::Rect& inner) { return geom::intersect(outer, inner) == inner; }

}  // namespace

ContextId WindowContents::context() {
    if (!context_) context_ = next_context_id();
    return *context_;
}

bool WindowContents::read_part(Node& node, ContextId context, const DrawTarget& target, std::uint32_t slot,
                               WindowPart& part) {
    const auto ask = [&](const ImageFormat& format) {
        return nodes_.ask_now(node, "window content", kAnswerLimitMs, [&](wire::PackBuffer& batch, RequestId request) {
            glapi::pack::ReadPixels(batch, request, slot, part.area.x, part.area.y, part.area.width, part.area.height,
                                    format.format, format.type);
        });
    };
    nodes_.batch(node, context);
    target.bind_to(node);
    auto colors = ask(kColors);
    if (!colors) return false;
    part.colors = std::move(*colors);
    if (target.format().depth_bits == 0) return true;
    auto depths = ask(depth_format(target.format()));
    if (!depths) return false;
    part.depths = std::move(*depths);
    return true;
}

/// Of the nodes that have it. What several show is read of the first.
std::vector<WindowPart> WindowContents::read(const DrawTarget& target) {
    std::vector<WindowPart> out;
    const ContextId context = this->context();
    const geom::Rect window{0, 0, static_cast<std::int32_t>(target.size().width),
                            static_cast<std::int32_t>(target.size().height)};
    for (const TargetLayer& layer : target.layers()) {
        Node& node = nodes_[layer];
        if (!node.answers() || node.slow || layer.view != 0 || !target.is_known_to(node)) continue;
        WindowPart part{geom::intersect(layer.pixels, window), {}, {}};
        if (part.area.empty() ||
            std::ranges::any_of(out, [&](const WindowPart& other) { return contains(other.area, part.area); }) ||
            std::int64_t{part.area.width} * part.area.height * kPixelBytes >= wire::kMaxFramePayload)
            continue;
        if (read_part(node, context, target, layer.slot, part)) out.push_back(std::move(part));
        else log(LogLevel::warn, "event=window_content_lost node=%u", node.index.value);
        if (node.alive()) glapi::pack::ContextDestroy(nodes_.batch(node, context), context);
    }
    return out;
}

void WindowContents::draw(Node& node, const DrawTarget& target, const std::vector<WindowPart>& parts) {
    const std::uint64_t slots = plain_slots(target, node.index);
    const ContextId context = this->context();
    const SurfaceFormat& format = target.format();
    wire::PackBuffer& buffer = nodes_.batch(node, context);
    target.bind_to(node);
    const std::size_t bytes = buffer.bytes();
    for (const WindowPart& part : parts) pack_plane(buffer, slots, part.area, kColors, part.colors);
    if (format.stencil_bits == 0) {  // where they are scaled, depths alone are drawn as fragments are
        pack_value<glstate::el::color_mask>(buffer, {0, 0, 0, 0});
        pack_value<glstate::el::depth_test>(buffer, true);
        pack_value<glstate::el::depth_func>(buffer, GL_ALWAYS);
    }
    for (const WindowPart& part : parts)
        if (!part.depths.empty()) pack_plane(buffer, slots, part.area, depth_format(format), part.depths);
    glapi::pack::ContextDestroy(buffer, context);
    count(node, NodeCounter::object_bytes, buffer.bytes() - bytes);
    nodes_.send(node);
}

void WindowContents::bring_now(const DrawTarget& target, bool anything_left) {
    ClientSurface& surface = *target.pictured_surface();
    std::vector<Node*> lacking;
    bool recorders_wait = false;  // for its next frame, with which it lies on them, too
    for (const auto& node : nodes_) {
        if (!node->alive()) continue;
        const bool lies_there = plain_slots(target, node->index) != 0;
        recorders_wait = recorders_wait || (node->records() && !lies_there);
        if (lies_there && !target.is_known_to(*node) && target.goes_to(*node)) lacking.push_back(node.get());
    }
    if (lacking.empty() && recorders_wait) return;
    surface.content_wanted = false;
    const bool was_drawn = surface.frame > 0 || surface.drawn;
    if (lacking.empty() || !was_drawn || target.format().stereo) return;
    std::vector<WindowPart> parts;
    if (anything_left) {
        const auto kept = kept_.find(surface.id);
        if (kept == kept_.end()) dealer_.compose(surface);
        parts = kept != kept_.end() ? kept->second : read(target);
    }
    for (Node* const node : lacking) {
        if (parts.empty()) target.describe_to(*node);
        else draw(*node, target, parts);
    }
}

void WindowContents::keep(ClientSurface& surface) {
    if (surface.frame == 0 && !surface.drawn) return;
    const DrawTarget target(surface);
    if (target.format().stereo) return;
    dealer_.compose(surface);
    if (auto parts = read(target); !parts.empty()) kept_.insert_or_assign(surface.id, std::move(parts));
}

}  // namespace wall::client
