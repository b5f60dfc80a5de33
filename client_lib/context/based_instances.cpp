// SPDX-License-Identifier: MIT
#include "client_lib/context/based_instances.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/glstate/diff.h"
#include "common/glstate/vertex_input.h"

namespace wall::client {
namespace {

constexpr auto kArrays = static_cast<std::size_t>(glstate::Category::vertex_arrays);

/// What would begin behind what can be named of a buffer begins at its end, where nothing is.
std::uint64_t moved(const glstate::ClientArray& array, std::uint32_t base) {
    const std::uint64_t step =
        array.stride != 0 ? static_cast<std::uint64_t>(array.stride) : glstate::element_bytes(array.type, array.size);
    const std::uint64_t to = array.pointer + step * base;
    return array.buffer == 0 ? to : std::min<std::uint64_t>(to, std::numeric_limits<std::uint32_t>::max());
}

}  // namespace

BasedInstances::BasedInstances(glstate::State& state, std::uint32_t base)
    : state_(state), arrays_(state.vertex_arrays), values_(state.ids[kArrays]) {
    for (glstate::ClientArray& array : state_.vertex_arrays.attrib_array)
        if (array.enabled && array.divisor != 0 && array.divisor != glstate::kNeverSteps)
            array.pointer = moved(array, base);
    state_.ids.renew(kArrays);
}

BasedInstances::~BasedInstances() {
    state_.vertex_arrays = arrays_;
    state_.ids.take(kArrays, values_);
}

}  // namespace wall::client
