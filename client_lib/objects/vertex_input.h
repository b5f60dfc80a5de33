// SPDX-License-Identifier: MIT
// Which arrays of which buffers a draw reads, as the nodes know it. It never changes: a program that sets its arrays
// anew makes another one, and finds the first again when it sets them back (context/vertex_inputs.h). So a draw names
// all of its arrays by one word, whether the program has vertex array objects or calls glVertexPointer for every mesh,
// and a node makes a vertex array object of it once. Used by the thread of the context that it belongs to; the
// definition by whoever holds the share group's mutex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "client_lib/objects/buffer.h"
#include "client_lib/objects/draw_pieces.h"
#include "client_lib/objects/object.h"
#include "common/geom/box.h"
#include "common/glstate/vertex_input.h"

namespace wall::client {

/// Which elements a draw of a vertex input takes.
struct DrawnRange {
    GLenum mode = GL_POINTS;
    GLenum index_type = 0;    ///< 0: `count` in a row from `first` on
    std::uint32_t first = 0;  ///< element, or where the indices begin in their buffer, bytes
    std::int32_t count = 0;
    std::int32_t base_vertex = 0;
    std::uint64_t restart = 0;  ///< 0: there is none; else 2^32 and the index
    std::uint32_t array = 0;    ///< which of the input's has the positions
    bool operator==(const DrawnRange&) const = default;
};

/// What is known of a range, as of the stamps of the buffers that it depends on.
struct RangeBounds {
    std::uint64_t positions = 0, indices = 0;  ///< stamps
    geom::Box box;                             ///< of the positions
    std::uint32_t first_element = 0;           ///< the lowest
    std::uint32_t last_element = 0;            ///< the highest
    std::shared_ptr<DrawPieces> pieces;        ///< null: it has never been worth while
    bool cut = false;                          ///< whether it is drawn in them
};

class VertexInput : public Object {
public:
    /// `buffers` are those that the definition names: of each array, then that of the indices, if there is one.
    VertexInput(ClientName own_id, glstate::VertexInputDefinition definition,
                std::vector<std::shared_ptr<Buffer>> buffers);

    const glstate::VertexInputDefinition& definition() const { return definition_; }
    const std::vector<std::shared_ptr<Buffer>>& buffers() const { return buffers_; }
    /// The array of positions; null: it has none.
    const glstate::InputArray* positions() const { return positions_ ? &definition_.arrays[*positions_] : nullptr; }
    /// Which array that is.
    std::optional<std::size_t> position_array() const { return positions_; }
    /// Which array has the values of a generic attribute; of number 0, that of positions.
    std::optional<std::size_t> array_of_generic(std::uint32_t number) const;
    /// Stamp of the latest change of itself or of any of its buffers: as long as it stays the same, who has been
    /// brought them lacks nothing of them. The share group's mutex is held.
    std::uint64_t latest_of_all() const {
        std::uint64_t latest = stamp_;
        for (const auto& buffer : buffers_) latest = std::max(latest, buffer->latest());
        return latest;
    }
    /// Null: none.
    const Buffer* indices() const { return definition_.indices ? buffers_.back().get() : nullptr; }
    const std::shared_ptr<Buffer>& shared_indices() const { return buffers_.back(); }
    /// Whether only nodes have the content of a buffer. The share group's mutex is held, here and below.
    bool any_drawn() const {
        return std::ranges::any_of(buffers_, [](const auto& buffer) { return buffer->is_drawn(); });
    }
    /// Whether a buffer is mapped so that no command may use it.
    bool blocked() const {
        return std::ranges::any_of(buffers_, [](const auto& buffer) { return buffer->blocked(); });
    }
    bool written_unseen() const {
        return std::ranges::any_of(buffers_, [](const auto& buffer) { return buffer->written_unseen(); });
    }
    /// Buffer::find_written() of what the arrays have of these elements; the buffers in which something was found.
    std::vector<ClientName> find_written(std::uint32_t first, std::uint32_t last);
    /// The same of a range of the indices.
    bool find_written_indices(ByteRange range) { return buffers_.back()->find_written(range); }
    /// What its elements take, each with all of its arrays, in a block of geometry.
    std::uint64_t inline_bytes(std::int32_t elements) const {
        return inline_bytes_ * static_cast<std::uint64_t>(elements);
    }
    /// How many elements lie in all of its buffers, as large as they are now; of those arrays that go on from vertex to
    /// vertex. The share group's mutex is held.
    std::uint64_t elements() const;
    /// The same of instances and the other arrays.
    std::uint64_t instances() const;

    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

    /// Stays until take_pieces().
    RangeBounds& bounds_of(const DrawnRange& range) {
        if (!latest_ || !(latest_->first == range)) latest_ = &*ranges_.try_emplace(range).first;
        return latest_->second;
    }
    /// More than that is a stream, of which no range comes again: they are to be forgotten.
    bool has_too_many_ranges() const { return ranges_.size() > kMostRanges; }
    static constexpr std::size_t kMostRanges = std::size_t{1} << 16;
    /// Forgets all ranges; their pieces, which nodes may know.
    std::vector<std::shared_ptr<DrawPieces>> take_pieces();

    std::uint64_t last_use = 0;  ///< of VertexInputs' own counting

private:
    struct RangeHash {
        std::size_t operator()(const DrawnRange& range) const {
            const std::uint64_t low = std::uint64_t{range.first} << 32 | static_cast<std::uint32_t>(range.count);
            const std::uint64_t rest = range.restart << 8 ^ static_cast<std::uint32_t>(range.base_vertex);
            return static_cast<std::size_t>(
                (low ^ rest * 0xff51afd7ed558ccdu ^ range.array << 16 ^ range.index_type << 4 ^ range.mode) *
                    0x9e3779b97f4a7c15u >>
                16);
        }
    };

    glstate::VertexInputDefinition definition_;
    std::vector<std::shared_ptr<Buffer>> buffers_;
    std::optional<std::size_t> positions_;  ///< among the arrays
    std::uint64_t inline_bytes_ = 0;        ///< of one element
    std::uint64_t stamp_ = next_stamp();
    std::unordered_map<DrawnRange, RangeBounds, RangeHash> ranges_;
    std::pair<const DrawnRange, RangeBounds>* latest_ = nullptr;  ///< the range asked for last; most have only one
};

}  // namespace wall::client
