// SPDX-License-Identifier: MIT
#include "client_lib/context/attribute_stack.h"

#include "common/glstate/diff.h"

namespace wall::client {
namespace {

template <class... E>
bool equal_elements(glstate::ElementList<E...>, const glstate::State& a, const glstate::State& b) {
    return ((std::memcmp(&E::ref(a, 0), &E::ref(b, 0), sizeof(typename E::type) * E::count) == 0) && ...);
}

template <std::size_t C>
void unify_category(glstate::State& state, const glstate::State& other) {
    if (state.ids[C] == other.ids[C]) return;
    using Elements = typename glstate::CategoryElements<static_cast<glstate::Category>(C)>::list;
    if (equal_elements(Elements{}, state, other)) state.ids.take(C, other.ids[C]);
}

template <std::size_t... C>
void unify_categories(glstate::State& state, const glstate::State& other, std::index_sequence<C...>) {
    (unify_category<C>(state, other), ...);
}

}  // namespace

void unify_value_ids(glstate::State& state, const glstate::State& other) {
    unify_categories(state, other, std::make_index_sequence<glstate::kCategoryCount>{});
}

}  // namespace wall::client
