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
        has_doubles_ = has_doubles_ || array.reaches_as == glstate::kAsDoubles;
    }
}

std::optional<std::size_t> VertexInput::array_of_generic(std::uint32_t number) const {
    if (number == 0) return positions_;
    const auto place = glstate::place_of(glstate::Attribute::vertex_attrib + number);
    for (std::size_t i = 0; i < definition_.arrays.size(); ++i)
        if (definition_.arrays[i].place == place) return i;
    return std::nullopt;
}

void VertexInput::settle() {
    const std::uint64_t as_of = Buffer::changes();
    const bool kept = count_drawn(uncounted_.elements, 1, uncounted_.nodes);
    uncounted_ = {};
    facts_ = {.as_of = as_of, .latest = stamp_, .elements = elements(), .instances = instances(), .kept = kept};
    for (const auto& buffer : buffers_) {
        facts_.latest = std::max(facts_.latest, buffer->latest());
        facts_.drawn |= buffer->is_drawn();
        facts_.blocked |= buffer->blocked();
        facts_.written_unseen |= buffer->written_unseen();
    }
}

bool VertexInput::count_drawn(std::uint64_t elements, std::uint64_t copies, std::uint64_t nodes) {
    bool keep = true;
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        const bool is_array = i < definition_.arrays.size();
        const auto components =
            is_array ? static_cast<std::uint64_t>(glstate::components(definition_.arrays[i].size)) : 0;
        const std::uint64_t bytes = components != 0 ? 1 + sizeof(float) * components : inline_bytes_;
        if (elements != 0) buffers_[i]->churn.drawn(bytes * elements * copies, nodes);
        keep = keep && buffers_[i]->churn.keep();
    }
    return keep;
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
