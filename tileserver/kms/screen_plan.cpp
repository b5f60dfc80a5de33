// SPDX-License-Identifier: MIT
#include "tileserver/kms/screen_plan.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "tileserver/kms/pairing.h"

namespace wall::tileserver {
namespace {

constexpr std::int64_t kSameRate = 500;  // millihertz: 59.94 Hz is what somebody means who writes 60

std::string of_tile(const MonitorWish& wish) { return "tile '" + wish.tile + "': "; }

std::string all_connectors(const Card& card) {
    std::string out;
    for (const Connector& connector : card.connectors)
        out +=
            (out.empty() ? "it has " : ", ") + text_of(connector) + (connector.connected ? "" : " without a monitor");
    return out.empty() ? "it has none" : out;
}

Result<std::vector<const Connector*>> choose_connectors(const Card& card, std::span<const MonitorWish> wishes) {
    const auto named = [&](const Connector& connector) {
        return std::ranges::count(wishes, connector.name, &MonitorWish::connector) > 0;
    };
    std::vector<const Connector*> out;
    auto next = card.connectors.begin();
    for (const MonitorWish& wish : wishes) {
        if (!wish.connector.empty()) {
            out.push_back(card.find(wish.connector));
            if (out.back() == nullptr)
                return fail(of_tile(wish) + card.name + " has no connector " + wish.connector + ": " +
                            all_connectors(card));
            continue;
        }
        next = std::find_if(next, card.connectors.end(), [&](const Connector& connector) {
            return connector.connected && connector.desktop && !named(connector);
        });
        if (next == card.connectors.end())
            return fail(of_tile(wish) + "no monitor is left for it: " + connected_monitors(card));
        out.push_back(&*next++);
    }
    return out;
}

Result<void> check_monitors(const Card& card, std::span<const MonitorWish> wishes,
                            const std::vector<const Connector*>& connectors) {
    bool any = false;
    for (std::size_t i = 0; i < wishes.size(); ++i) {
        if (!connectors[i]->connected) continue;
        any = true;
        if (auto mode = choose_mode(*connectors[i], wishes[i].mode); !mode)
            return fail(of_tile(wishes[i]) + mode.error().message);
    }
    if (any) return {};
    return fail(of_tile(wishes.front()) + "no monitor at " + connectors.front()->name + ": " +
                connected_monitors(card));
}

/// What a CRTC is paired with, as numbers in `all`.
template <class Object, class Fits>
std::vector<std::size_t> numbers_of(const std::vector<Object>& all, Fits&& fits) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (fits(all[i])) out.push_back(i);
    return out;
}

bool contains(const std::vector<CrtcId>& crtcs, CrtcId crtc) { return std::ranges::count(crtcs, crtc) > 0; }

/// A CRTC for each connector.
Result<std::vector<const Crtc*>> choose_crtcs(const Card& card, const std::vector<const Connector*>& connectors) {
    std::vector<std::vector<std::size_t>> candidates;
    for (const Connector* connector : connectors) {
        candidates.push_back(
            numbers_of(card.crtcs, [&](const Crtc& crtc) { return contains(connector->crtcs, crtc.id); }));
        // What drives it already is tried first.
        const auto current = connector->properties.find("CRTC_ID");
        if (current != connector->properties.end())
            std::ranges::stable_partition(
                candidates.back(), [&](std::size_t i) { return card.crtcs[i].id.value == current->second.value; });
    }
    const auto pairs = pair_up(candidates, card.crtcs.size());
    if (!pairs) {
        std::string names;
        for (const Connector* connector : connectors) names += (names.empty() ? "" : ", ") + connector->name;
        return fail(card.name + " cannot show pictures at all of these at once: " + names + "; it makes " +
                    std::to_string(card.crtcs.size()) + " signals, and not each of them for each connector");
    }
    std::vector<const Crtc*> out;
    for (const std::size_t crtc : *pairs) out.push_back(&card.crtcs[crtc]);
    return out;
}

/// A primary plane for each CRTC.
Result<std::vector<const Plane*>> choose_planes(const Card& card, const std::vector<const Crtc*>& crtcs) {
    std::vector<std::vector<std::size_t>> candidates;
    for (const Crtc* crtc : crtcs)
        candidates.push_back(numbers_of(card.planes, [&](const Plane& plane) {
            return plane.primary && plane.plain && contains(plane.crtcs, crtc->id);
        }));
    const auto pairs = pair_up(candidates, card.planes.size());
    if (!pairs)
        return fail(card.name + " has no primary plane for pixels of 8 bits a channel (XRGB8888) for each of " +
                    std::to_string(crtcs.size()) + " monitors");
    std::vector<const Plane*> out;
    for (const std::size_t plane : *pairs) out.push_back(&card.planes[plane]);
    return out;
}

/// What is better comes first.
auto rank_of(const Mode& mode, std::uint32_t wanted) {
    const auto off = wanted == 0 ? 0 : std::abs(std::int64_t{mode.millihertz} - wanted);
    return std::tuple(off, !mode.preferred, -std::int64_t{mode.millihertz});
}

}  // namespace

Result<Mode> choose_mode(const Connector& connector, const std::optional<ModeWish>& wish) {
    if (!connector.connected) return fail("no monitor at " + connector.name);
    const Mode* best = nullptr;
    std::string known;
    for (const Mode& mode : connector.modes) {
        if (mode.interlaced) continue;
        known += (known.empty() ? "it has " : ", ") + text_of(mode);
        const auto rate = wish ? wish->millihertz : 0;
        if (wish && (mode.width != wish->width || mode.height != wish->height)) continue;
        if (rate != 0 && std::abs(std::int64_t{mode.millihertz} - rate) > kSameRate) continue;
        // A monitor without a favourite has its best mode first.
        const bool better =
            best != nullptr && (wish ? rank_of(mode, rate) < rank_of(*best, rate) : mode.preferred && !best->preferred);
        if (best == nullptr || better) best = &mode;
    }
    if (best != nullptr) return *best;
    const std::string wanted =
        !wish ? "picture that is not interlaced"
              : "picture of " + std::to_string(wish->width) + "x" + std::to_string(wish->height) +
                    (wish->millihertz == 0 ? "" : " at " + std::to_string((wish->millihertz + 500) / 1000) + " Hz");
    return fail("the monitor at " + text_of(connector) + " has no " + wanted + ": " +
                (known.empty() ? "it says nothing of any" : known));
}

Result<std::vector<ScreenPlan>> plan_screens(const Card& card, std::span<const MonitorWish> wishes) {
    const auto connectors = choose_connectors(card, wishes);
    if (!connectors) return tl::unexpected(connectors.error());
    if (auto checked = check_monitors(card, wishes, *connectors); !checked) return tl::unexpected(checked.error());
    const auto crtcs = choose_crtcs(card, *connectors);
    if (!crtcs) return tl::unexpected(crtcs.error());
    const auto planes = choose_planes(card, *crtcs);
    if (!planes) return tl::unexpected(planes.error());
    std::vector<ScreenPlan> out;
    for (std::size_t i = 0; i < wishes.size(); ++i) out.push_back({*(*connectors)[i], *(*crtcs)[i], *(*planes)[i]});
    return out;
}

}  // namespace wall::tileserver
