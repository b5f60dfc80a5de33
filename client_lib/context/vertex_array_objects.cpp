// SPDX-License-Identifier: MIT
#include "client_lib/context/vertex_array_objects.h"

#include <utility>

#include "common/glstate/diff.h"

namespace wall::client {
namespace {

constexpr auto kArrays = static_cast<std::size_t>(glstate::Category::vertex_arrays);

}  // namespace

VertexArrayObjects::Arrays VertexArrayObjects::take(const glstate::State& state) {
    return {state.vertex_arrays, state.ids[kArrays], std::move(bindings)};
}

void VertexArrayObjects::load(glstate::State& state, Arrays arrays) {
    state.vertex_arrays = arrays.arrays;
    state.ids.take(kArrays, arrays.values);
    bindings = std::move(arrays.bindings);
}

void VertexArrayObjects::bind(glstate::State& state, GLuint name) {
    const GLuint bound = state.vertex_arrays.vertex_array_object;
    if (bound == name) return;
    if (bound == 0) {
        unnamed_ = take(state);
    } else {
        names_.find(bound)->arrays = std::make_unique<Arrays>(take(state));
        ++kept_;
    }
    if (name == 0) return load(state, *std::exchange(unnamed_, std::nullopt));
    const auto known = names_.find(name);
    if (known) {
        load(state, std::move(*known->arrays));
        known->arrays.reset();
        --kept_;
        return;
    }
    names_.put(name, std::make_shared<Kept>());
    Arrays fresh;
    fresh.arrays.vertex_array_object = name;
    fresh.values = glstate::next_value_id();
    load(state, std::move(fresh));
}

bool VertexArrayObjects::erase(glstate::State& state, GLuint name) {
    if (name == 0 || !names_.known(name)) return false;
    if (state.vertex_arrays.vertex_array_object == name) bind(state, 0);
    if (names_.erase(name)) --kept_;
    return true;
}

}  // namespace wall::client
