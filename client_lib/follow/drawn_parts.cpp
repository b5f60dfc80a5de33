// SPDX-License-Identifier: MIT
#include "client_lib/follow/drawn_parts.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <utility>

#include "client_lib/follow/hidden_part.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/link/parallel.h"
#include "client_lib/process/log.h"
#include "client_lib/process/options.h"
#include "client_lib/process/stats.h"

namespace wall::client {
namespace {

constexpr int kAnswerLimitMs = 5000;  // a node answers behind all that it has to draw before
constexpr PixelRect kEverything{-1e9f, -1e9f, 1e9f, 1e9f}, kNowhere{2e9f, 2e9f, 2e9f, 2e9f};
constexpr float kMargin = 2;  // pixels: one that a scaled window is made of at the border of a tile, one beside it

void enclose(PixelRect& all, const PixelRect& more) {
    if (all.x0 == kNowhere.x0) all = more;
    all = {std::min(all.x0, more.x0), std::min(all.y0, more.y0), std::max(all.x1, more.x1), std::max(all.y1, more.y1)};
}

PixelRect moved(const PixelRect& area, std::int32_t x, std::int32_t y) {
    if (area.x0 == kNowhere.x0 || area.x0 == kEverything.x0) return area;
    const auto dx = static_cast<float>(x), dy = static_cast<float>(y);
    return {area.x0 - dx, area.y0 - dy, area.x1 - dx, area.y1 - dy};
}

/// Of an image, whole pixels.
geom::Rect pixels_of(const PixelRect& area, std::uint32_t width, std::uint32_t height) {
    const auto within = [](float value, std::uint32_t most) {
        return static_cast<std::int32_t>(std::clamp(value, 0.0f, static_cast<float>(most)));
    };
    const std::int32_t left = within(std::floor(area.x0), width), right = within(std::ceil(area.x1), width),
                       bottom = within(std::floor(area.y0), height), top = within(std::ceil(area.y1), height);
    return {left, bottom, right - left, top - bottom};
}

/// Nodes need not have all of it, and there are several that show some of it.
bool is_worth_it(const ImageParts& parts) {
    return std::ranges::count_if(parts.layers, [](const TargetLayer& layer) {
               return layer.area.x0 != kNowhere.x0 && layer.area.x0 != kEverything.x0;
           }) > 1;
}

/// Pixels of the canvas that an image covers which begins there in the window; edges are rounded as those of layers.
std::uint32_t shown_pixels(std::int32_t first, std::uint32_t pixels, double scale) {
    const auto edge = [&](double at) { return std::floor(at * scale + 0.5); };
    return static_cast<std::uint32_t>(edge(static_cast<double>(first) + pixels) - edge(first));
}

/// At the wall's resolution.
void enlarge(ImageParts& parts, std::uint32_t width, std::uint32_t height) {
    parts.images_width = parts.images_height = 0;
    if (parts.scale_x == 1 && parts.scale_y == 1) return;
    parts.images_width = shown_pixels(parts.window_x, width, parts.scale_x);
    parts.images_height = shown_pixels(parts.window_y, height, parts.scale_y);
}

/// What one node has of some rows of an image, over what others have.
void put_part(const PixelRect& part, const ImageRows& rows, std::span<const std::byte> from, std::span<std::byte> to) {
    const auto width = static_cast<std::uint32_t>(rows.width);
    const std::size_t pixels = static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(rows.count);
    if (pixels == 0 || from.size() != to.size() || from.size() % pixels != 0) return;
    const std::size_t pixel_bytes = from.size() / pixels;
    const geom::Rect own = geom::intersect(pixels_of(part, width, static_cast<std::uint32_t>(rows.first + rows.count)),
                                           {0, rows.first, rows.width, rows.count});
    for (std::int32_t y = own.y; y < own.y + own.height; ++y) {
        const std::size_t at =
            (static_cast<std::size_t>(y - rows.first) * width + static_cast<std::size_t>(own.x)) * pixel_bytes;
        std::memcpy(to.data() + at, from.data() + at, static_cast<std::size_t>(own.width) * pixel_bytes);
    }
}

}  // namespace

/// A window that may show more than its own tiles have now, or otherwise than it is, is left alone.
std::shared_ptr<ImageParts> DrawnParts::parts_in(const ClientSurface& window, std::int32_t x, std::int32_t y) const {
    const SurfaceLayout& layout = window.layout;
    if (window.whole || layout.offscreen || !layout.views.empty() || options().broadcast || !options().drawn_parts ||
        parallel())
        return nullptr;
    auto parts = std::make_shared<ImageParts>();
    parts->window = window.id;
    parts->layout = layout.version;
    parts->x = parts->window_x = x, parts->y = parts->window_y = y;
    const double scale_x = static_cast<double>(layout.rect.width) / layout.width,
                 scale_y = static_cast<double>(layout.rect.height) / layout.height;
    if (scale_x >= 1 && scale_y >= 1) parts->scale_x = scale_x, parts->scale_y = scale_y;
    for (TargetLayer layer : nodes_.everywhere()) {
        layer.area = nodes_[layer].records() ? kEverything : kNowhere;
        for (const TargetLayer& shown : layout.layers)
            if (shown.node == layer.node) enclose(layer.area, shown.area);
        if (window.hidden && window.hidden->layer.node == layer.node) enclose(layer.area, window.hidden->layer.area);
        if (layer.area.x0 != kNowhere.x0 && layer.area.x0 != kEverything.x0)
            layer.area = {layer.area.x0 - kMargin, layer.area.y0 - kMargin, layer.area.x1 + kMargin,
                          layer.area.y1 + kMargin};
        layer.area = moved(layer.area, x, y);
        parts->layers.push_back(layer);
    }
    return parts;
}

std::shared_ptr<ImageParts> DrawnParts::parts_in(const ImageParts& between, std::int32_t x, std::int32_t y) const {
    auto parts = std::make_shared<ImageParts>(between);
    parts->between = between.stamp;
    parts->x = x, parts->y = y;
    parts->window_x += x, parts->window_y += y;
    if (between.images_width == 0) parts->scale_x = parts->scale_y = 1;
    for (TargetLayer& layer : parts->layers) layer.area = moved(layer.area, x, y);
    return parts;
}

/// All nodes have what is to be drawn in parts from now on.
bool DrawnParts::hold_all(const Drawn& drawn) const {
    return std::ranges::all_of(nodes_, [&](const auto& node) {
        if (!node->stream) return true;
        return node->alive() && node->left_out.empty() && node->holds(drawn.target_id) &&
               std::ranges::all_of(drawn.images, [&](ClientName image) { return node->holds(image); });
    });
}

void DrawnParts::begin(const std::shared_ptr<DrawnTarget>& target, const DrawSource& source, std::int32_t x,
                       std::int32_t y) {
    DrawnTarget* const between = source.draw.objects();
    const ClientSurface* const window = source.draw.pictured_surface();
    std::shared_ptr<ImageParts> parts;
    if (between && between->parts()) parts = parts_in(*between->parts(), x, y);
    else if (!between && window) parts = parts_in(*window, x, y);
    if (!parts || !is_worth_it(*parts)) return;
    add(target, source, std::move(parts));
}

void DrawnParts::inherit(const std::shared_ptr<DrawnTarget>& target, const DrawSource& source, std::int32_t x,
                         std::int32_t y) {
    add(target, source, parts_in(*source.read.objects()->parts(), -x, -y));
}

void DrawnParts::add(const std::shared_ptr<DrawnTarget>& target, const DrawSource& source,
                     std::shared_ptr<ImageParts> parts) {
    Drawn drawn{source.share, target, target->target_id(), {}, parts};
    {
        std::lock_guard lock(source.share->mutex);
        if (!target->may_be_larger()) parts->scale_x = parts->scale_y = 1;
        target->for_each_image([&](const Object& image) {
            if (std::ranges::find(drawn.images, image.id) == drawn.images.end()) drawn.images.push_back(image.id);
        });
    }
    if (!hold_all(drawn) || std::ranges::any_of(drawn.images, [&](ClientName image) { return find(image) != nullptr; }))
        return;
    enlarge(*parts, target->width(), target->height());
    parts->stamp = next_stamp();
    parts->nodes = nodes_.changes();
    parts->definition = target->defined();
    target->draw_parts(std::move(parts));
    tell(drawn, target.get());
    stats().add("drawn_parts_begun");
    seen_.clear();  // what is drawn with just as before is looked at once more
    drawn_.push_back(std::move(drawn));
}

/// Nodes are told when it begins, and when it is over (`target` null).
void DrawnParts::tell(const Drawn& drawn, const DrawnTarget* target) {
    for (const TargetLayer& layer : drawn.parts->layers) {
        Node& node = nodes_[layer];
        if (!node.alive() || !node.holds(drawn.target_id) || layer.area.x0 == kEverything.x0) continue;
        wire::PackBuffer& buffer = nodes_.batch(node, node.batch_context);
        if (target == nullptr) {
            glapi::pack::TargetWhole(buffer, drawn.target_id);
            continue;
        }
        const geom::Rect part = pixels_of(layer.area, target->width(), target->height());
        glapi::pack::TargetPart(buffer, drawn.target_id, part.x, part.y, static_cast<std::uint32_t>(part.width),
                                static_cast<std::uint32_t>(part.height), drawn.parts->images_width,
                                drawn.parts->images_height);
    }
}

bool DrawnParts::still_good(const DrawnTarget& target) const {
    const ImageParts& parts = *target.parts();
    const auto window = surfaces_.find(parts.window);
    return window != surfaces_.end() && window->second->layout.version == parts.layout && !window->second->whole &&
           nodes_.changes() == parts.nodes && target.defined() == parts.definition;
}

bool DrawnParts::suffice(DrawnTarget& target, const DrawTarget& copied_to, std::int32_t x, std::int32_t y) {
    const ImageParts* const parts = target.parts();
    if (!parts || !still_good(target) || parts->x != x || parts->y != y) return false;
    const DrawnTarget* const between = copied_to.objects();
    if (between) return between->parts() && between->parts()->stamp == parts->between;
    const ClientSurface* const window = copied_to.pictured_surface();
    return window && parts->between == 0 && window->id == parts->window;
}

DrawnParts::Drawn* DrawnParts::find(ClientName image) {
    const auto found = std::ranges::find_if(
        drawn_, [&](const Drawn& drawn) { return std::ranges::find(drawn.images, image) != drawn.images.end(); });
    return found == drawn_.end() ? nullptr : &*found;
}

/// Whether a draw looks at images that are drawn in parts otherwise than it may, or draws to them by another target.
/// That a target is bound to be read from is no use of it.
bool DrawnParts::sees_images(const DrawSource& source) {
    std::unordered_map<ClientName, int> uses;
    const DrawnTarget* const own = source.draw.objects();
    bool other_target = false;
    {
        std::lock_guard lock(source.share->mutex);
        source.draw.for_each_image([&](const Object& image) {
            const Drawn* const drawn = find(image.id);
            other_target = other_target || (drawn && drawn->target.lock().get() != own);
            if (drawn) --uses[image.id];
        });
        source.read.for_each_image([&](const Object& image) {
            if (find(image.id)) --uses[image.id];
        });
    }
    if (other_target) return true;
    if (const auto allowed = allowed_.find(source.id); allowed != allowed_.end())
        for (const ClientName image : allowed->second)
            if (find(image)) --uses[image];
    source.objects.for_each_used([&](const Object& object) {
        if (find(object.id)) ++uses[object.id];
    });
    return std::ranges::any_of(uses, [](const auto& use) { return use.second > 0; });
}

/// What shaders write every node must write alike.
void DrawnParts::end_if_needed(const DrawSource& source) {
    const DrawnTarget* const own = source.draw.objects();
    if (own && own->parts() && (!still_good(*own) || source.objects.writes())) return end(*source.share);
    UseStamp& seen = seen_[source.id];
    if (seen == source.used) return;
    if (sees_images(source)) return end(*source.share);
    if (!allowed_.contains(source.id)) seen = source.used;
}

void DrawnParts::allow(ContextId context, std::vector<ClientName> images) {
    if (images.empty()) allowed_.erase(context);
    else allowed_[context] = std::move(images);
}

void DrawnParts::before_object_changes(ClientName object) {
    if (drawn_.empty()) return;
    if (const Drawn* const drawn = find(object)) end(*drawn);
}

void DrawnParts::forget(ClientName object) {
    for (Drawn& drawn : drawn_) std::erase(drawn.images, object);
    const auto gone = std::ranges::find(drawn_, object, &Drawn::target_id);
    if (gone != drawn_.end()) end(*gone);
}

/// With all of its group.
void DrawnParts::end(const Drawn& one) {
    if (const auto share = one.share.lock()) return end(*share);
    std::erase_if(drawn_, [](const Drawn& drawn) { return drawn.share.expired(); });
}

void DrawnParts::end(const ShareGroup& share) {
    std::vector<Drawn> over;
    std::erase_if(drawn_, [&](Drawn& drawn) {
        if (drawn.share.lock().get() != &share) return false;
        over.push_back(std::move(drawn));
        return true;
    });
    if (!over.empty()) stats().add("drawn_parts_ended", over.size());
    for (const Drawn& drawn : over) {
        tell(drawn, nullptr);
        if (const auto target = drawn.target.lock()) target->draw_whole();
    }
    for (const Drawn& drawn : over) gather(drawn);
}

void DrawnParts::end_all() {
    while (!drawn_.empty()) end(drawn_.front());
}

// ---- all of an image, of what each node has ----

void DrawnParts::gather(const Drawn& drawn) {
    const auto share = drawn.share.lock();
    if (!share) return;
    std::lock_guard lock(share->mutex);
    for (const ClientName image : drawn.images)
        if (const auto found = share->by_id.find(image); found != share->by_id.end())
            gather(*drawn.parts, *found->second);
}

/// What no node has drawn is as any of them has it.
void DrawnParts::gather(const ImageParts& parts, const Object& image) {
    if (!image.is_drawn()) return;  // several samples a pixel cannot be read
    std::vector<const TargetLayer*> holders;
    for (const TargetLayer& layer : parts.layers) {
        Node& node = nodes_[layer];
        if (!node.answers() || !node.holds(image.id)) continue;
        ObjectSender(nodes_, node, node.batch).send(image);  // what was changed since it was drawn
        holders.push_back(&layer);
    }
    const auto ask = [&](const auto& pack, const ImageRows& rows) -> std::optional<std::vector<std::byte>> {
        std::optional<std::vector<std::byte>> all;
        for (const TargetLayer* const layer : holders) {
            if (all && layer->area.x0 == kNowhere.x0) continue;
            auto answer = nodes_.ask_now(nodes_[*layer], "drawn parts", kAnswerLimitMs, pack);
            if (!answer || answer->empty()) continue;
            if (!all) all = std::move(answer);
            else put_part(layer->area, rows, *answer, *all);
        }
        return all;
    };
    KeptContent content;
    const auto end_part = [&] { content.ends.push_back(content.commands.mark()); };
    image.pack_drawn(ask, content.commands, end_part);
    end_part();
    for (const auto& node : nodes_)
        if (node->alive() && node->holds(image.id)) give(*node, content);
}

void DrawnParts::give(Node& node, const KeptContent& content) {
    wire::PackMark first;
    for (const wire::PackMark& end : content.ends) {
        nodes_.batch(node, node.batch_context).append(content.commands, first, end);
        count(node, NodeCounter::object_bytes, end.operand_bytes - first.operand_bytes);
        first = end;
        nodes_.send(node);
    }
}

}  // namespace wall::client
