// SPDX-License-Identifier: MIT
// Deals the geometry of windows to nodes, and has it composed (deal.h). The session's mutex is held.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/node_updater.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/geometry/needs.h"
#include "client_lib/link/parallel.h"
#include "client_lib/process/measured_choice.h"
#include "common/wire/limits.h"

namespace wall::client {

/// In a Block's mask: its other bits number layers that other nodes show.
inline constexpr std::uint64_t kPartialBit = std::uint64_t{1} << wire::kPartialSlot;

class Dealer {
public:
    /// All of them outlive it. `wanted`: programs ask for it (WALLGL_SORT_LAST). `group`: a process of which one this
    /// is.
    Dealer(Nodes& nodes, NodeUpdater& updater, bool wanted, const std::optional<Parallel>& group = parallel())
        : nodes_(nodes), updater_(updater), wanted_(wanted), group_(group) {}

    /// The wall lets geometry be dealt that nobody asks for, where that is measured to be faster.
    void allow_measured(bool allowed) { measured_ = allowed; }

    /// One node's part of a draw.
    struct Dealt {
        Node* node = nullptr;
        std::uint64_t mask = 0;               ///< of its Block; 0: none of the layers shows it
        std::uint32_t first = 0, behind = 0;  ///< of its pieces; 0 and 0: it draws all of it
    };
    /// Who draws this, in order; nobody: it is not dealt. `elements`: about so many; 0: it is no geometry. `pieces`: as
    /// in Drawn. Good until the next call.
    std::span<const Dealt> deal(const DrawSource& source, const Reach& reach, double elements,
                                std::uint32_t pieces = 0);
    /// The nodes of what deal() has returned just now, each with the layers that its parts touch. Good until the next
    /// deal().
    const NodeMasks& dealt_to();
    /// The node's batch behind everything that drawing this needs there.
    wire::PackBuffer& prepare(Node& node, const DrawSource& source, const Needs& needs);
    /// What was dealt is in the layers of tiles before anything else happens to them. `target` may be anything.
    void compose(const DrawTarget& target);
    void compose(ClientSurface& surface);
    /// A frame of the window is over, composed before.
    void finish_frame(ClientSurface& surface);
    /// The program may go on behind a frame. `waited`: how long it has waited for nodes behind its frames so far.
    void note_frame(MeasuredChoice::Time now, MeasuredChoice::Clock::duration waited);
    /// The stream is held on all nodes until the semaphore is above 0, then takes one. What this process is dealt it
    /// may draw before that, for nobody sees it until it is composed: so processes that blend one behind the other draw
    /// at the same time. `windows`: all of the process, composed before.
    void take_semaphore(const OpenSurfaces& windows, ContextId context, std::uint32_t name);
    /// What else is said to nodes now happens behind them.
    void take_held_semaphores();

private:
    bool may_deal(const ClientSurface& surface) const;
    std::optional<std::uint32_t> composition_of(const DrawSource& source, const ClientSurface& surface) const;
    void choose(ClientSurface& surface);
    bool draws_for_others(const OpenSurfaces& windows, const Node& node);
    static void hear_paces(Deal& deal);
    std::vector<TargetLayer> receivers_of(const ClientSurface& surface) const;
    void cut(Deal& deal, std::uint64_t mask, double elements, std::uint32_t pieces);
    std::vector<NodeIndex> compositors_of(const Deal& deal, std::size_t drawn) const;
    void compose_by(std::span<const NodeIndex> compositors, ClientSurface& surface,
                    std::span<const std::uint32_t> drawn);
    static void pack_begin(wire::PackBuffer& buffer, const ClientSurface& surface);

    Nodes& nodes_;
    NodeUpdater& updater_;
    const bool wanted_;
    bool measured_ = false;
    MeasuredChoice faster_{{.better = 1.1, .least = 8}};  ///< to deal, by frames
    MeasuredChoice::Clock::duration waited_before_{};     ///< by the beginning of the while that is measured
    const std::optional<Parallel>& group_;
    std::vector<Dealt> dealt_;       ///< used again and again
    NodeMasks dealt_to_;             ///< the same
    bool holds_semaphores_ = false;  ///< some node does
};

}  // namespace wall::client
