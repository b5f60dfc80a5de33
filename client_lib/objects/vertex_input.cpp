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
        inline_bytes_ += 1 + sizeof(float) * static_cast<std::uint64_t>(glstate::components(array.size));
        if (!positions_ && holds_positions(array)) positions_ = i;
    }
}

std::optional<std::size_t> VertexInput::array_of_generic(std::uint32_t number) const {
    if (number == 0) return positions_;
    const auto place = glstate::place_of(glstate::Attribute::vertex_attrib + number);
    for (std::size_t i = 0; i < definition_.arrays.size(); ++i)
        if (definition_.arrays[i].place == place) return i;
    return std::nullopt;
}

std::uint64_t VertexInput::elements() const {
    std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < definition_.arrays.size(); ++i)
        if (definition_.arrays[i].divisor == 0)
            count = std::min(count, definition_.arrays[i].elements_in(buffers_[i]->size()));
    return count;
}

std::uint64_t VertexInput::instances() const {
    std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < definition_.arrays.size(); ++i) {
        const glstate::InputArray& array = definition_.arrays[i];
        if (array.divisor == 0) continue;
        count = std::min(count, array.elements_in(buffers_[i]->size()) * array.divisor);
    }
    return count;
}

std::vector<ClientName> VertexInput::find_written(std::uint32_t first, std::uint32_t last) {
    std::vector<ClientName> out;
    for (std::size_t i = 0; i < definition_.arrays.size(); ++i) {
        const glstate::InputArray& array = definition_.arrays[i];
        Buffer& buffer = *buffers_[i];
        if (!buffer.written_unseen()) continue;
        const bool each_vertex = array.divisor == 0;  // of the others, all
        const std::size_t begin = array.offset + (each_vertex ? array.step() * first : 0);
        const std::size_t end =
            each_vertex ? array.offset + array.step() * last + array.element_bytes() : buffer.size();
        if (buffer.find_written({begin, std::min(end, buffer.size())})) out.push_back(buffer.id);
    }
    return out;
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
    latest_ = nullptr;
    return out;
}

}  // namespace wall::client
