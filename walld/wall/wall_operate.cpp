// SPDX-License-Identifier: MIT
// What operators do with the wall's windows.
#include <algorithm>
#include <charconv>

#include "walld/wall/messages.h"
#include "walld/wall/wall.h"

namespace wall::walld {
namespace {

template <class T>
std::optional<T> number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return {};
    return value;
}

tl::unexpected<Refusal> no_session(SessionId id) {
    return refuse(RefusalKind::not_found, "there is no session " + std::to_string(id.value));
}
tl::unexpected<Refusal> no_window(const Target& target) {
    return refuse(RefusalKind::not_found, "session " + std::to_string(target.session.value) + " has no window " +
                                              std::to_string(target.surface.value));
}
tl::unexpected<Refusal> no_window_yet(SessionId id) {
    return refuse(RefusalKind::conflict, "session " + std::to_string(id.value) + " has no window yet");
}

}  // namespace

void Wall::tell_pattern(NodeIndex node, std::uint32_t slot, const proto::TilePattern& pattern) {
    auto told = pattern;
    told.set_slot(slot);
    out_.to_node(node, make(&proto::Envelope::mutable_tile_pattern, told));
}

Outcome<void> Wall::set_pattern(const std::string& tile, const proto::TilePattern& pattern) {
    for (const NodeIndex node : nodes_.ids()) {
        const auto& tiles = nodes_[node].config->tiles;
        const auto found = std::ranges::find(tiles, tile, &config::TileConfig::name);
        if (found == tiles.end()) continue;
        if (pattern.kind() == proto::TilePattern::NONE) patterns_.erase(tile);
        else patterns_[tile] = pattern;
        if (nodes_[node].up) tell_pattern(node, found->slot, pattern);
        return {};
    }
    return refuse(RefusalKind::not_found, "there is no tile '" + tile + "'");
}

Outcome<Target> Target::parse(std::string_view text) {
    const auto dot = text.find('.');
    const auto session = number<std::uint32_t>(text.substr(0, dot));
    const auto surface =
        dot == std::string_view::npos ? std::optional<std::uint32_t>(0) : number<std::uint32_t>(text.substr(dot + 1));
    if (session && surface) return Target{SessionId(*session), SurfaceId(*surface)};
    return refuse(RefusalKind::invalid,
                  "'" + std::string(text) +
                      "' is no session: expected its number, or NUMBER.SURFACE, as `wallctl sessions` shows them");
}

Outcome<SurfaceKey> Wall::resolve(const Target& target) const {
    if (!sessions_.contains(target.session)) return no_session(target.session);
    for (auto key = stacking_.rbegin(); key != stacking_.rend(); ++key) {
        if (key->session == target.session && (!target.surface || key->surface == target.surface)) return *key;
    }
    return target.surface ? no_window(target) : no_window_yet(target.session);
}

Outcome<std::vector<SurfaceKey>> Wall::surfaces_of(const Target& target) const {
    if (!sessions_.contains(target.session)) return no_session(target.session);
    std::vector<SurfaceKey> out;
    for (const auto& key : stacking_) {
        if (key.session == target.session && (!target.surface || key.surface == target.surface)) out.push_back(key);
    }
    if (target.surface && out.empty()) return no_window(target);
    return out;
}

Outcome<void> Wall::place_surface(const Target& target, const geom::Rect& rect) {
    if (auto possible = check_place(config_.canvas(), rect); !possible) return possible;
    const auto key = resolve(target);
    if (!key) return tl::unexpected(key.error());
    find(key->surface, key->session)->scaled = true;
    want(*key, rect);
    return {};
}

Outcome<void> Wall::raise(const Target& target) {
    const auto keys = surfaces_of(target);
    if (!keys) return tl::unexpected(keys.error());
    for (const auto& key : *keys) {
        std::erase(stacking_, key);
        stacking_.push_back(key);
        find(key.surface, key.session)->layout_z.reset();
    }
    send_stacking();
    return {};
}

Outcome<void> Wall::lower(const Target& target) {
    const auto keys = surfaces_of(target);
    if (!keys) return tl::unexpected(keys.error());
    for (const auto& key : *keys) {
        std::erase(stacking_, key);
        find(key.surface, key.session)->layout_z.reset();
    }
    stacking_.insert(stacking_.begin(), keys->begin(), keys->end());
    send_stacking();
    return {};
}

Outcome<std::vector<SurfaceKey>> Wall::ask_to_close(const Target& target) {
    auto keys = surfaces_of(target);
    if (!keys) return keys;
    for (const auto& key : *keys) {
        find(key.surface, key.session)->cannot_close = false;
        proto::CloseRequest request;
        request.set_surface(key.surface.value);
        request.set_reason("closed by an operator");
        out_.to_client(key.session, make(&proto::Envelope::mutable_close_request, request));
    }
    return keys;
}

Outcome<void> Wall::hold(const Target& target, bool on, Clock::time_point now) {
    const auto keys = surfaces_of(target);
    if (!keys) return tl::unexpected(keys.error());
    if (!target.surface) find(target.session)->held = on;
    for (const auto& key : *keys) {
        auto& swap = find(key.surface, key.session)->swap;
        present(key, on ? swap.hold(now) : swap.release(now), now);
    }
    send_stacking();  // with what is held
    return {};
}

Outcome<void> Wall::step(const Target& target, std::uint32_t frames, Clock::time_point now) {
    const auto keys = surfaces_of(target);
    if (!keys) return tl::unexpected(keys.error());
    if (keys->empty()) return no_window_yet(target.session);
    for (const auto& key : *keys) present(key, find(key.surface, key.session)->swap.step(frames, now), now);
    return {};
}

/// Nodes hear of it with the ticket that they have.
Outcome<void> Wall::set_weight(const Target& target, std::uint32_t weight) {
    auto* session = find(target.session);
    if (!session) return no_session(target.session);
    session->weight = weight;
    for (const NodeIndex node : nodes_.ids())
        if (nodes_[node].up) hand_out_ticket(target.session, *session, node);
    for (const auto& [surface, entry] : session->surfaces) tell_note({target.session, surface});
    return {};
}

Outcome<void> Wall::set_stereo(const Target& target, const std::optional<proto::Stereo>& stereo) {
    auto* session = find(target.session);
    if (!session) return no_session(target.session);
    if (session->group && stereo)
        return refuse(RefusalKind::conflict,
                      "a parallel program's processes draw one picture together: expected another program");
    session->stereo = stereo;
    for (const auto& [surface, entry] : session->surfaces) want({target.session, surface}, entry.place.wanted());
    return {};
}

Outcome<void> Wall::ask_to_move(const Target& target, const std::string& address) {
    const auto* session = find(target.session);
    if (!session) return no_session(target.session);
    if (session->group)
        return refuse(RefusalKind::conflict, "a parallel program's processes cannot go to another wall together");
    move_answers_.erase(target.session);
    proto::MoveRequest request;
    request.set_address(address);
    out_.to_client(target.session, make(&proto::Envelope::mutable_move_request, request));
    return {};
}

void Wall::move_answered(SessionId id, const proto::MoveAnswer& answer) { move_answers_[id] = answer.refused(); }

std::optional<std::string> Wall::take_move_answer(SessionId id) {
    auto found = move_answers_.extract(id);
    return found ? std::optional(std::move(found.mapped())) : std::nullopt;
}

// ---- layouts ----

WindowName Wall::name_of(const SurfaceKey& key) const {
    const auto& session = sessions_.at(key.session);
    return {session.name, session.program, find(key)->title};
}

Layout Wall::current_layout() const {
    const auto canvas = config_.canvas();
    Layout layout{canvas.width, canvas.height, {}};
    for (const auto& key : stacking_) {
        const auto& surface = *find(key);
        layout.windows.push_back({name_of(key), surface.place.wanted(), surface.scaled, layout.windows.size()});
    }
    return layout;
}

std::size_t Wall::load_layout(const Layout& layout) {
    const auto canvas = config_.canvas();
    free_places_ = scaled_to(layout, canvas.width, canvas.height).windows;
    // Only what cannot be seen on this wall at all is left where it is.
    std::erase_if(free_places_, [&](const LayoutEntry& entry) { return !check_place(canvas, entry.rect); });
    auto keys = stacking_;
    std::ranges::sort(keys);  // the oldest windows get the first places, whatever lies above what now
    std::map<std::size_t, SurfaceKey> placed;
    for_each_surface([](const SurfaceKey&, SurfaceEntry& surface) { surface.layout_z.reset(); });
    for (const auto& key : keys) {
        const auto entry = take_place(free_places_, name_of(key));
        if (!entry) continue;
        auto& surface = *find(key.surface, key.session);
        surface.scaled = entry->scaled;
        surface.layout_z = entry->z;
        placed[entry->z] = key;
        auto rect = entry->rect;
        if (!entry->scaled)
            rect = {rect.x, rect.y, static_cast<std::int32_t>(surface.width),
                    static_cast<std::int32_t>(surface.height)};
        want(key, rect);
    }
    for (const auto& [z, key] : placed) {
        std::erase(stacking_, key);
        stacking_.push_back(key);
    }
    layout_loaded_ = true;
    waiting_places_changed();
    send_stacking();
    return placed.size();
}

}  // namespace wall::walld
