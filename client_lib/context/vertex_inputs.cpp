// SPDX-License-Identifier: MIT
#include "client_lib/context/vertex_inputs.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>

namespace wall::client {
namespace {

using glstate::Attribute;
using glstate::ClientArray;
using glstate::InputArray;

/// An enabled array as nodes are told of it; nothing: it is not in a buffer, or lies where none can be.
std::optional<InputArray> input_array(std::uint32_t place, const ClientArray& array) {
    if (array.buffer == 0 || array.pointer > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    return InputArray{.place = place,
                      .buffer = ClientName(array.buffer),
                      .offset = static_cast<std::uint32_t>(array.pointer),
                      .stride = array.stride,
                      .type = array.type,
                      .size = array.size,
                      .normalized = array.normalized,
                      .divisor = array.divisor,
                      .reaches_as = array.reaches_as};
}

/// False: not all arrays are in buffers.
bool define(const glstate::State& state, bool indexed, glstate::VertexInputDefinition& out) {
    out.arrays.clear();
    out.indices = indexed ? ClientName(state.vertex_arrays.element_array_buffer) : ClientName();
    bool all = true;
    const auto add = [&](std::uint32_t place, const ClientArray& array) {
        if (!array.enabled) return;
        const auto input = input_array(place, array);
        if (input) out.arrays.push_back(*input);
        else all = false;
    };
    glstate::for_each_attribute_array(state, [&](Attribute attribute, const ClientArray& array) {
        add(static_cast<std::uint32_t>(place_of(attribute)), array);
    });
    add(glstate::kPositionArray, state.vertex_arrays.vertex_array);
    return all;
}

/// All of its buffers; empty: one is gone.
std::vector<std::shared_ptr<Buffer>> buffers_of(const BufferUse& use,
                                                const glstate::VertexInputDefinition& definition) {
    std::vector<std::shared_ptr<Buffer>> out;
    const auto add = [&](ClientName id) {
        const auto found = use.by_id.find(id);
        if (found == use.by_id.end()) return false;
        out.push_back(found->second);
        return true;
    };
    for (const InputArray& array : definition.arrays)
        if (!add(array.buffer)) return {};
    if (definition.indices && !add(definition.indices)) return {};
    return out;
}

}  // namespace

std::size_t VertexInputs::Hash::operator()(const glstate::VertexInputDefinition& definition) const {
    const std::string_view arrays(reinterpret_cast<const char*>(definition.arrays.data()),
                                  definition.arrays.size() * sizeof(InputArray));
    return std::hash<std::string_view>{}(arrays) ^ definition.indices.value * std::size_t{0x9e3779b97f4a7c15};
}

VertexInput* VertexInputs::current(const glstate::State& state, const BufferUse& buffers, ShareGroup& share,
                                   bool indexed) {
    const std::uint64_t arrays = state.ids[static_cast<std::size_t>(glstate::Category::vertex_arrays)];
    Latest& latest = latest_[indexed];
    if (latest.arrays != arrays) {
        const bool named = state.vertex_arrays.vertex_array_object != 0;
        Latest& at = named ? place_of(arrays, indexed) : latest;
        if (at.arrays != arrays) at = {arrays, find(state, buffers, share, indexed)};
        latest = at;
    }
    if (latest.input) latest.input->last_use = ++uses_;
    return latest.input;
}

VertexInputs::Latest& VertexInputs::place_of(std::uint64_t arrays, bool indexed) {
    auto& remembered = remembered_[indexed];
    if (remembered.empty()) remembered.resize(kRemembered);
    // Programs set up their objects one like the other, so that ids lie at regular distances.
    return remembered[(arrays * std::uint64_t{0x9e3779b97f4a7c15} >> 32) % kRemembered];
}

VertexInput* VertexInputs::find(const glstate::State& state, const BufferUse& use, ShareGroup& share, bool indexed) {
    if (!define(state, indexed, looked_for_)) return nullptr;
    // Frames are drawn like the ones before, mesh after mesh: a look at the successor instead of one for the name.
    VertexInput*& successor = before_ ? before_->successor : before_;
    if (!successor || !(successor->definition() == looked_for_)) successor = of(looked_for_, use, share);
    return before_ = successor;
}

VertexInput* VertexInputs::of(const glstate::VertexInputDefinition& definition, const BufferUse& use,
                              ShareGroup& share) {
    if (const auto found = known_.find(definition); found != known_.end()) {
        found->second->last_use = ++uses_;
        return found->second.get();
    }
    auto buffers = buffers_of(use, definition);
    if (buffers.empty() && (!definition.arrays.empty() || definition.indices)) return nullptr;
    auto input = std::make_shared<VertexInput>(next_object_id(), definition, std::move(buffers));
    input->last_use = ++uses_;
    {
        std::lock_guard lock(share.mutex);
        share.by_id[input->id] = input;
    }
    return known_.emplace(definition, std::move(input)).first->second.get();
}

template <class Goes>
std::vector<std::shared_ptr<VertexInput>> VertexInputs::take(Goes&& goes) {
    std::vector<std::shared_ptr<VertexInput>> out;
    std::erase_if(known_, [&](auto& entry) {
        if (!goes(*entry.second)) return false;
        out.push_back(std::move(entry.second));
        return true;
    });
    before_ = nullptr;
    for (auto& [definition, input] : known_) input->successor = nullptr;
    for (Latest& latest : latest_) latest = {};
    for (auto& remembered : remembered_) remembered.clear();
    return out;
}

std::vector<std::shared_ptr<VertexInput>> VertexInputs::take_those_of(ClientName buffer) {
    return take([&](const VertexInput& input) {
        return std::ranges::any_of(input.buffers(), [&](const auto& used) { return used->id == buffer; });
    });
}

std::vector<std::shared_ptr<VertexInput>> VertexInputs::take_all() {
    return take([](const VertexInput&) { return true; });
}

std::vector<std::shared_ptr<VertexInput>> VertexInputs::take_unused() {
    if (known_.size() <= kMost) return {};
    std::vector<std::uint64_t> uses;
    for (const auto& [definition, input] : known_) uses.push_back(input->last_use);
    const auto middle = uses.begin() + static_cast<std::ptrdiff_t>(uses.size() / 2);
    std::ranges::nth_element(uses, middle);
    return take([oldest = *middle](const VertexInput& input) { return input.last_use < oldest; });
}

}  // namespace wall::client
