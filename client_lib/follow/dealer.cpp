// SPDX-License-Identifier: MIT
#include "client_lib/follow/dealer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "client_lib/follow/surface.h"
#include "client_lib/process/options.h"
#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

/// Of a window; so many a node reads back and sends.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 24;
constexpr std::uint32_t kFirstBand = wire::kMaxTilesPerNode;  ///< names of bands are no tiles'
constexpr double kWaits = 0.5;  ///< share of its time that a program waits for nodes whose drawing holds it up

/// Each node that composes has rows of every layer, of about as many pixels: what lies in the middle of a window is
/// shared as well.
geom::Rect band_of(const geom::Rect& layer, std::size_t number, std::size_t count) {
    const auto row = [&](std::size_t at) { return static_cast<int>(layer.height * at / count); };
    return {layer.x, layer.y + row(number), layer.width, row(number + 1) - row(number)};
}

std::uint32_t name_of_band(std::size_t layer, std::size_t number, std::size_t count) {
    return kFirstBand + static_cast<std::uint32_t>(layer * count + number);
}

/// As PartialSend and PartialCompose have it.
void add_band(std::vector<std::uint32_t>& words, const std::array<std::uint32_t, 3>& what, const geom::Rect& area) {
    words.insert(words.end(), what.begin(), what.end());
    for (const int value : {area.x, area.y, area.width, area.height})
        words.push_back(static_cast<std::uint32_t>(value));
}

/// Of those who draw.
std::vector<std::uint32_t> bands_of(const Deal& deal, std::span<const NodeIndex> compositors) {
    std::vector<std::uint32_t> words;
    for (std::size_t layer = 0; layer < deal.receivers.size(); ++layer)
        for (std::size_t i = 0; i < compositors.size(); ++i)
            add_band(
                words,
                {static_cast<std::uint32_t>(layer), compositors[i].value, name_of_band(layer, i, compositors.size())},
                band_of(deal.receivers[layer].pixels, i, compositors.size()));
    return words;
}

}  // namespace

bool Dealer::may_deal(const ClientSurface& surface) const {
    const SurfaceFormat& format = surface.options.format;
    const SurfaceLayout& layout = surface.layout;
    const bool plain = format.double_buffered && format.depth_bits != 0 && format.samples == 0 && !format.stereo;
    const bool as_it_is = layout.rect.width == static_cast<int>(layout.width) &&
                          layout.rect.height == static_cast<int>(layout.height) && layout.views.empty();
    return (wanted_ || (measured_ && faster_.other())) && !options().broadcast && surface.options.visible &&
           !surface.whole && plain && as_it_is && std::uint64_t{layout.width} * layout.height <= kMostPixels;
}

/// One program's blending is left alone: by each part that is rounded by itself its picture would become another one.
/// The processes of a parallel program say by semaphores and barriers what lies over what.
std::optional<std::uint32_t> Dealer::composition_of(const DrawSource& source, const ClientSurface& surface) const {
    const auto by = composed_by(source.state, surface.options.format.alpha_bits != 0);
    return by == GL_BLEND && !group_ ? std::nullopt : by;
}

/// Who draws in this frame, and how much. Each process of a parallel program has one node.
void Dealer::choose(ClientSurface& surface) {
    Deal& deal = surface.deal;
    deal.chosen = true;
    deal.hands.clear();
    deal.compositors.clear();
    if (!may_deal(surface)) return;
    std::vector<NodeIndex> render;
    for (const auto& node : nodes_)
        if (node->info.renders && node->answers() && !node->slow) render.push_back(node->index);
    if (group_ && !render.empty()) render = {render[group_->rank % render.size()]};
    for (const auto& node : nodes_)
        if (node->info.composes && node->answers() && !node->slow) deal.compositors.push_back(node->index);
    hear_paces(deal);
    const std::vector<double> ends = deal.paces.ends(render);
    for (std::size_t i = 0; i < render.size(); ++i) deal.hands.push_back({render[i], ends[i]});
}

void Dealer::hear_paces(Deal& deal) {
    std::erase_if(deal.asked, [&](Deal::Asked& asked) {
        if (!asked.answer.done()) return false;
        std::uint64_t took = 0;
        for (const auto& answer : asked.answer.take_answers())
            if (answer.size() == sizeof took) std::memcpy(&took, answer.data(), sizeof took);
        if (took != 0) deal.paces.note(asked.node, asked.elements, std::chrono::nanoseconds(took));
        return true;
    });
}

/// A layer of the whole window has all of it, whatever is to be seen there.
std::vector<TargetLayer> Dealer::receivers_of(const ClientSurface& surface) const {
    std::vector<TargetLayer> out;
    const auto width = surface.layout.width, height = surface.layout.height;
    for (const TargetLayer& layer : surface.layout.layers) {
        const Node& node = nodes_[layer];
        if (!node.alive() || node.records()) continue;
        out.push_back(layer);
        if (layer.is_whole_window()) out.back().pixels = {0, 0, static_cast<int>(width), static_cast<int>(height)};
    }
    return out;
}

std::span<const Dealer::Dealt> Dealer::deal(const DrawSource& source, const Reach& reach, double elements,
                                            std::uint32_t pieces) {
    dealt_.clear();
    ClientSurface* const surface = source.draw.pictured_surface();
    if (surface == nullptr || elements <= 0) return {};
    Deal& deal = surface->deal;
    if (!deal.chosen) choose(*surface);
    if (deal.hands.empty() || source.objects.writes()) return {};
    const auto by = composition_of(source, *surface);
    if (!by) return {};
    if (deal.open && deal.by != *by) compose(*surface);
    if (!deal.open) deal.receivers = receivers_of(*surface);
    if (deal.receivers.empty() || deal.receivers.size() > wire::kTileSlots) return {};
    std::uint64_t mask = 0;
    for (std::size_t i = 0; i < deal.receivers.size(); ++i)
        if (reach.touches(deal.receivers[i])) mask |= std::uint64_t{1} << i;
    cut(deal, mask != 0 ? mask | kPartialBit : 0, elements, pieces);
    deal.open = true;
    deal.by = *by;
    if (mask != 0) deal.cost += elements;
    return dealt_;
}

/// A frame is taken to have as many elements as the one before. A node that has gone in mid-frame draws no more of it.
void Dealer::cut(Deal& deal, std::uint64_t mask, double elements, std::uint32_t pieces) {
    const double whole = deal.cost_before > 0 ? deal.cost_before : pieces > 1 ? elements : 0;
    const std::size_t last = deal.hands.size() - 1;
    const auto hand_at = [&](double cost) {
        std::size_t hand = 0;
        while (hand < last && whole > 0 && cost >= deal.hands[hand].end * whole) ++hand;
        return hand;
    };
    const double each = elements / std::max(pieces, 1u);
    const auto add = [&](std::size_t at, std::uint32_t first, std::uint32_t behind) {
        Deal::Hand& hand = deal.hands[at];
        if (mask != 0) hand.elements += behind != 0 ? (behind - first) * each : elements;
        dealt_.push_back({&nodes_[hand.node], mask, first, behind});
    };
    const std::size_t begin = hand_at(deal.cost);
    if (pieces <= 1 || hand_at(deal.cost + elements) == begin) return add(begin, 0, 0);
    for (std::uint32_t first = 0; first < pieces;) {
        const std::size_t hand = hand_at(deal.cost + first * each);
        const double end = std::ceil((deal.hands[hand].end * whole - deal.cost) / each);  // of its run, in pieces
        const auto behind =
            hand == last ? pieces : static_cast<std::uint32_t>(std::clamp(end, first + 1.0, double{1} * pieces));
        add(hand, first, behind);
        first = behind;
    }
}

/// Each has one part: they draw in turn.
const NodeMasks& Dealer::dealt_to() {
    dealt_to_.clear();
    for (const Dealt& part : dealt_)
        if (part.mask != 0) dealt_to_.push_back({part.node->index, part.mask});
    return dealt_to_;
}

wire::PackBuffer& Dealer::prepare(Node& node, const DrawSource& source, const Needs& needs) {
    ClientSurface& surface = *source.draw.pictured_surface();
    Deal& deal = surface.deal;
    const MarkingState marking(source.state, deal.by, deal.marking);
    wire::PackBuffer& buffer = updater_.prepare(node, source, needs);
    const auto hand = std::ranges::find(deal.hands, node.index, &Deal::Hand::node);
    if (hand != deal.hands.end() && !hand->drew) {
        hand->drew = true;
        pack_begin(buffer, surface);
    }
    return buffer;
}

void Dealer::compose(const DrawTarget& target) {
    if (ClientSurface* const surface = target.pictured_surface()) return compose(*surface);
    take_held_semaphores();
}

void Dealer::compose(ClientSurface& surface) {
    Deal& deal = surface.deal;
    if (!std::exchange(deal.open, false)) return take_held_semaphores();
    ++deal.sequence;
    std::vector<std::uint32_t> drawn;
    for (Deal::Hand& hand : deal.hands)
        if (hand.drew && nodes_[hand.node].alive()) drawn.push_back(hand.node.value);
    const auto compositors = compositors_of(deal, drawn.size());
    const std::vector<std::uint32_t> bands = bands_of(deal, compositors);
    for (Deal::Hand& hand : deal.hands) {
        if (!std::exchange(hand.drew, false) || !nodes_[hand.node].alive()) continue;
        Node& node = nodes_[hand.node];
        const RequestId request = nodes_.next_request();
        glapi::pack::PartialSend(nodes_.batch(node, node.batch_context), surface.id, deal.sequence, hand.node.value,
                                 request, std::as_bytes(std::span(bands)));
        nodes_.send(node);
        deal.asked.push_back({hand.node, std::exchange(hand.elements, 0), {}});
        deal.asked.back().answer.add(node.stream, request);
    }
    take_held_semaphores();
    if (drawn.empty()) return;
    compose_by(compositors, surface, drawn);
    std::vector<std::uint32_t> from = drawn;
    if (!compositors.empty()) {
        from.clear();
        for (const NodeIndex node : compositors) from.push_back(node.value);
    }
    const DrawTarget target(surface);
    for (const auto& [index, slots] : nodes_touched(deal.receivers, std::nullopt)) {
        Node& node = nodes_[index];
        if (!node.alive() || !target.goes_to(node)) continue;
        wire::PackBuffer& buffer = nodes_.batch(node, node.batch_context);
        target.describe_to(node);
        glapi::pack::PartialMerge(buffer, surface.id, deal.sequence, deal.by, static_cast<std::uint32_t>(slots),
                                  static_cast<std::uint32_t>(slots >> 32), std::as_bytes(std::span(from)));
    }
}

/// Where only one has drawn there is nothing to put together.
std::vector<NodeIndex> Dealer::compositors_of(const Deal& deal, std::size_t drawn) const {
    std::vector<NodeIndex> out;
    if (drawn < 2) return out;
    int rows = deal.receivers.front().pixels.height;
    for (const TargetLayer& layer : deal.receivers) rows = std::min(rows, layer.pixels.height);
    for (const NodeIndex node : deal.compositors)
        if (nodes_[node].alive() && static_cast<int>(out.size()) < rows) out.push_back(node);
    return out;
}

/// Behind what they have drawn themselves.
void Dealer::compose_by(std::span<const NodeIndex> compositors, ClientSurface& surface,
                        std::span<const std::uint32_t> drawn) {
    const Deal& deal = surface.deal;
    for (std::size_t i = 0; i < compositors.size(); ++i) {
        std::vector<std::uint32_t> words(drawn.begin(), drawn.end());
        for (std::size_t layer = 0; layer < deal.receivers.size(); ++layer) {
            const TargetLayer& to = deal.receivers[layer];
            const auto name = name_of_band(layer, i, compositors.size());
            add_band(words, {name, to.node.value, to.slot}, band_of(to.pixels, i, compositors.size()));
        }
        Node& node = nodes_[compositors[i]];
        const DrawTarget target(surface);
        wire::PackBuffer& buffer = nodes_.batch(node, node.batch_context);
        target.describe_to(node);
        glapi::pack::PartialCompose(buffer, surface.id, deal.sequence, deal.by, node.index.value,
                                    static_cast<std::uint32_t>(drawn.size()), std::as_bytes(std::span(words)));
        nodes_.send(node);
    }
}

void Dealer::pack_begin(wire::PackBuffer& buffer, const ClientSurface& surface) {
    std::vector<std::uint32_t> words;
    for (const TargetLayer& layer : surface.deal.receivers)
        for (const auto word :
             {layer.node.value, layer.slot, static_cast<std::uint32_t>(layer.pixels.x),
              static_cast<std::uint32_t>(layer.pixels.y), static_cast<std::uint32_t>(layer.pixels.width),
              static_cast<std::uint32_t>(layer.pixels.height)})
            words.push_back(word);
    glapi::pack::PartialBegin(buffer, surface.id, surface.deal.by, std::as_bytes(std::span(words)));
}

bool Dealer::draws_for_others(const OpenSurfaces& windows, const Node& node) {
    if (!wanted_) return false;
    return std::ranges::any_of(windows, [&](const auto& window) {
        Deal& deal = window.second->deal;
        if (!deal.chosen) choose(*window.second);
        return std::ranges::find(deal.hands, node.index, &Deal::Hand::node) != deal.hands.end();
    });
}

void Dealer::take_semaphore(const OpenSurfaces& windows, ContextId context, std::uint32_t name) {
    for (auto& node : nodes_) {
        if (!node->alive()) continue;
        if (draws_for_others(windows, *node)) {
            node->held_semaphores.push_back(name);
            holds_semaphores_ = true;
            continue;
        }
        glapi::pack::SemaphoreP(nodes_.batch(*node, context), name);
        nodes_.send(*node);
    }
}

void Dealer::take_held_semaphores() {
    if (!std::exchange(holds_semaphores_, false)) return;
    for (auto& node : nodes_) {
        if (!node->alive()) continue;
        for (const std::uint32_t name : std::exchange(node->held_semaphores, {})) {
            glapi::pack::SemaphoreP(nodes_.batch(*node, node->batch_context), name);
            nodes_.send(*node);
        }
    }
}

// Where the program does not wait for nodes they could draw faster for nobody. Whether dealing still pays is asked
// again and again: what is drawn, and where, is another thing by then.
void Dealer::note_frame(MeasuredChoice::Time now, MeasuredChoice::Clock::duration waited) {
    if (wanted_ || !measured_) return;
    const auto renders = std::ranges::count_if(
        nodes_, [](const auto& node) { return node->info.renders && node->answers() && !node->slow; });
    faster_.done(
        1, faster_.other(), now,
        [&](double seconds) {
            const double share = std::chrono::duration<double>(waited - waited_before_).count() / seconds;
            return MeasuredChoice::Seen{.usual_in_doubt = renders > 1 && share > kWaits, .other_in_doubt = true};
        },
        [&] { waited_before_ = waited; });
}

void Dealer::finish_frame(ClientSurface& surface) {
    Deal& deal = surface.deal;
    deal.chosen = false;
    deal.cost_before = std::exchange(deal.cost, 0);
}

}  // namespace wall::client
