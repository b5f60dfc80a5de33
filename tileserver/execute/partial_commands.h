// SPDX-License-Identifier: MIT
// Groups [partial] and [piece_range]: pictures that several nodes of a sort-last session draw parts of (A3.3). What a
// node draws for others lies in a layer of its own, whose stencil buffer tells what was drawn; it is read back and
// sent, and merged into the layers of tiles pixel by pixel, exactly as if its geometry had been drawn there. Render
// thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tileserver/execute/execution.h"
#include "tileserver/partials/partial_format.h"

namespace wall::tileserver {

class PartialCommands {
public:
    /// `execution` outlives it.
    explicit PartialCommands(Execution& execution) : execution_(execution) {}

    void PartialBegin(SurfaceId surface, GLenum by, std::span<const std::byte> receivers);
    void PartialSend(SurfaceId surface, std::uint32_t sequence, std::uint32_t from, RequestId request,
                     std::span<const std::byte> bands);
    void PartialCompose(SurfaceId surface, std::uint32_t sequence, GLenum by, std::uint32_t from, std::uint32_t nodes,
                        std::span<const std::byte> parts);
    void PieceRange(std::uint32_t first, std::uint32_t behind);
    void PartialMerge(SurfaceId surface, std::uint32_t sequence, GLenum by, std::uint32_t slots_low,
                      std::uint32_t slots_high, std::span<const std::byte> nodes);

    /// A merge is not done.
    bool merging() const { return merge_.has_value(); }
    /// It would have to wait.
    bool waits() const;
    /// Merges, if it need not wait.
    void go_on();

private:
    using Clock = std::chrono::steady_clock;
    /// A part of a layer that a node composes for the one that shows it.
    struct Band {
        std::uint32_t layer = 0;  ///< who draws: number of the layer; who composes: the band's name
        NodeIndex node;           ///< that it goes to
        std::uint32_t slot = 0;   ///< the name that it goes by there
        geom::Rect area;          ///< window pixels
    };
    struct Merge {
        SurfaceId surface;
        std::uint32_t sequence = 0;
        GLenum by = GL_LESS;
        std::vector<PartialKey> keys;  ///< by slot, in the order of drawing
        Clock::time_point begun;
        std::vector<Band> bands;  ///< that are composed for others; none: it is merged into layers here
        NodeIndex self;           ///< who composes
    };

    SurfaceReplica* known_surface(SurfaceId id);
    Rank rank() const { return execution_.session.rank(); }
    std::vector<std::byte> take_partial(const PartialLayers::One& partial, const geom::Rect& area,
                                        const PartialKey& key, GLenum by) const;
    /// Nothing: they cannot be, and the command is refused.
    std::optional<std::vector<Band>> bands_of(std::span<const std::byte> bytes, const SurfaceReplica& surface);
    void send(NodeIndex to, NodeIndex self, std::vector<std::byte> message);
    void merge_layers(const Merge& merge, SurfaceReplica& surface);
    void compose_bands(const Merge& merge);
    void compose_band(const Band& band, std::span<const PartialKey> keys, const Merge& merge);
    /// Nothing: it has not come, or is none.
    std::optional<Partial> take(const PartialKey& key);
    void merge_into(Layer& layer, std::span<const PartialKey> keys, GLenum by);

    Execution& execution_;
    std::optional<Merge> merge_;
};

}  // namespace wall::tileserver
