// SPDX-License-Identifier: MIT
#include "client_lib/objects/vertex_input.h"

#include <algorithm>
#include <limits>

#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

/// glVertexAttribPointer's array 0, which comes first, takes the place of glVertexPointer's.
bool holds_positions(const glstate::InputArray& array) {
    return array.place == glstate::kPositionArray ||
           array.place == glstate::place_of(glstate::Attribute::vertex_attrib);
}

}  // namespace

VertexInput::VertexInput(ClientName own_id, glstate::VertexInputDefinition definition,
                         std::vector<std::shared_ptr<Buffer>> buffers)
    : Object(own_id), definition_(std::move(definition)), buffers_(std::move(buffers)) {
    for (std::size_t i = 0; i < definition_.arrays.size(); ++i) {
        const glstate::InputArray& array = definition_.arrays[i];
        inline_bytes_ += 1 + sizeof(float) * static_cast<std::uint64_t>(array.size);
        if (!positions_ && holds_positions(array)) positions_ = i;
    }
}

std::uint64_t VertexInput::elements() const {
    std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < definition_.arrays.size(); ++i)
        count = std::min(count, definition_.arrays[i].elements_in(buffers_[i]->size()));
    return count;
}

void VertexInput::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    glapi::pack::VertexInput(buffer, id, glstate::encode(definition_));
    packed();
}

std::vector<std::shared_ptr<DrawPieces>> VertexInput::take_pieces() {
    std::vector<std::shared_ptr<DrawPieces>> out;
    for (auto& [range, bounds] : ranges_)
        if (bounds.pieces) out.push_back(std::move(bounds.pieces));
    ranges_.clear();
    return out;
}

}  // namespace wall::client
