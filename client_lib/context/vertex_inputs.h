// SPDX-License-Identifier: MIT
// From the arrays that a context has enabled to the vertex input that names them. While nothing of the arrays changes
// that is one comparison; else the arrays as they are now are looked up among those that were drawn with before, so
// that a program that goes through its meshes by glVertexPointer tells a node of each once. The context's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "client_lib/context/buffer_use.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/vertex_input.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

class VertexInputs {
public:
    /// The enabled arrays of a context with these buffers; with that of the indices if `indexed`. Null: not all of them
    /// lie in buffers. The share group, whose mutex is taken, knows what is new.
    VertexInput* current(const glstate::State& state, const BufferUse& buffers, ShareGroup& share, bool indexed);
    /// The input of a definition; null: one of its buffers is gone.
    VertexInput* of(const glstate::VertexInputDefinition& definition, const BufferUse& buffers, ShareGroup& share);
    /// Takes out, when there are too many, the half that was not used for longest; they were told to nodes.
    std::vector<std::shared_ptr<VertexInput>> take_unused();
    /// Takes out those that read the buffer; they were told to nodes.
    std::vector<std::shared_ptr<VertexInput>> take_those_of(ClientName buffer);
    std::vector<std::shared_ptr<VertexInput>> take_all();

    static constexpr std::size_t kMost = 4096;

private:
    struct Hash {
        std::size_t operator()(const glstate::VertexInputDefinition& definition) const;
    };
    /// What the arrays were, by their category's value id.
    struct Latest {
        std::uint64_t arrays = 0;
        VertexInput* input = nullptr;
    };
    /// Of vertex array objects, which come again with the value ids that they had: a place for each id, which another
    /// one takes.
    static constexpr std::size_t kRemembered = 2048;
    Latest& place_of(std::uint64_t arrays, bool indexed);
    VertexInput* find(const glstate::State& state, const BufferUse& buffers, ShareGroup& share, bool indexed);
    template <class Goes>
    std::vector<std::shared_ptr<VertexInput>> take(Goes&& goes);

    std::unordered_map<glstate::VertexInputDefinition, std::shared_ptr<VertexInput>, Hash> known_;
    Latest latest_[2];                           ///< without and with indices
    std::vector<Latest> remembered_[2];          ///< the same; empty until a vertex array object is drawn with
    VertexInput* before_ = nullptr;              ///< found last
    glstate::VertexInputDefinition looked_for_;  ///< its memory is used again
    std::uint64_t uses_ = 0;
};

}  // namespace wall::client
