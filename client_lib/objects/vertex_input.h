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
    std::uint64_t found_within = 0;            ///< Buffer::changes() when all of it was found to lie in the buffers
    geom::Box box;                             ///< of the positions
    std::uint32_t first_element = 0;           ///< the lowest
    std::uint32_t last_element = 0;            ///< the highest
    std::shared_ptr<DrawPieces> pieces;        ///< null: it has never been worth while
    bool cut = false;                          ///< whether it is drawn in them
};

/// What the buffers of an input are, all together.
struct InputFacts {
    std::uint64_t as_of = 0;   ///< Buffer::changes(); 0: never looked at
    std::uint64_t latest = 0;  ///< stamp of the latest change of the input or any buffer: as long as it stays the same,
                               ///< who has been brought them lacks nothing of them
    std::uint64_t elements = 0;   ///< that lie in all of the buffers; of those arrays that go on from vertex to vertex
    std::uint64_t instances = 0;  ///< the same of the other arrays
    bool drawn = false;           ///< only nodes have the content of one
    bool blocked = false;         ///< one is mapped so that no command may use it
    bool written_unseen = false;  ///< one is mapped so that the program may write into it at any time
    bool kept = false;            ///< all are worth keeping on the nodes

    /// What most are: nothing has to be looked at before a draw.
    bool plain() const { return kept && !drawn && !blocked && !written_unseen; }
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
    /// Whether facts() are known as they are now.
    bool settled() const { return facts_.as_of == Buffer::changes(); }
    /// The share group's mutex is held, unless it is settled.
    const InputFacts& facts() {
        if (!settled()) settle();
        return facts_;
    }
    /// Whether a shader takes doubles from it, which no block of vertices has.
    bool has_doubles() const { return has_doubles_; }
    /// Null: none.
    const Buffer* indices() const { return definition_.indices ? buffers_.back().get() : nullptr; }
    const std::shared_ptr<Buffer>& shared_indices() const { return buffers_.back(); }
    /// A draw of so many elements, which without buffers would travel to `nodes` nodes, `copies` times in all. Whether
    /// the buffers are worth keeping on the nodes: each is charged with what its own arrays would take; that of the
    /// indices with all, since without it every element would come along. The share group's mutex is held.
    bool count_drawn(std::uint64_t elements, std::uint64_t copies, std::uint64_t nodes);
    /// The same where the facts say that they are kept: it is counted when anything has changed. Without the mutex.
    void count_drawn_later(std::uint64_t elements, std::uint64_t copies, std::uint64_t nodes) {
        uncounted_.elements += elements * copies;
        uncounted_.nodes = std::max(uncounted_.nodes, nodes);
    }
    /// Buffer::find_written() of what the arrays have of these elements; the buffers in which something was found.
    std::vector<ClientName> find_written(std::uint32_t first, std::uint32_t last);
    /// The same of a range of the indices.
    bool find_written_indices(ByteRange range) { return buffers_.back()->find_written(range); }
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

    std::uint64_t last_use = 0;        ///< of VertexInputs' own counting
    VertexInput* successor = nullptr;  ///< the one that was drawn with after it; VertexInputs' own

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

    void settle();
    std::uint64_t elements() const;
    std::uint64_t instances() const;

    InputFacts facts_;
    struct {
        std::uint64_t elements = 0, nodes = 0;
    } uncounted_;
    glstate::VertexInputDefinition definition_;
    std::vector<std::shared_ptr<Buffer>> buffers_;
    std::optional<std::size_t> positions_;  ///< among the arrays
    bool has_doubles_ = false;
    std::uint64_t inline_bytes_ = 0;  ///< what one element takes in a block of geometry
    std::uint64_t stamp_ = next_stamp();
    std::unordered_map<DrawnRange, RangeBounds, RangeHash> ranges_;
    std::pair<const DrawnRange, RangeBounds>* latest_ = nullptr;  ///< the range asked for last; most have only one
};

}  // namespace wall::client
