// SPDX-License-Identifier: MIT
// What of a context's state a command can depend on. Everything else waits: a clear does not bring matrices up to date,
// unlit geometry no lights, and an attribute that a block sets before its first vertex is not sent ahead of it. What
// waited is still different from the node's mirror, so the next difference that includes it sends it. Pure.
#pragma once

#include "client_lib/geometry/packer.h"
#include "common/glstate/diff.h"

namespace wall::client {

struct Needs {
    glstate::CategoryMask categories = glstate::kSentCategories;
    std::uint32_t spared = 0;  ///< current attributes that need not be sent, a bit for each Attribute
    static_assert(kAttributes <= 32);

    bool waits(Attribute a) const { return spared >> static_cast<unsigned>(a) & 1; }
    void spare(Attribute a) { spared |= 1u << static_cast<unsigned>(a); }
};

/// glClear, glAccum.
Needs needs_of_clear();
/// Vertices, drawn with this state.
Needs needs_of_geometry(const glstate::State& state);
/// A packed block: the same, less what it sets itself in time.
Needs needs_of_block(const glstate::State& state, const Packer& packer);

/// What of `needs` has to be compared with this mirror: the origin of an earlier modelview matrix waits, too, unless
/// the node would take its own origin for this matrix's.
glstate::CategoryMask categories_to_send(const Needs& needs, const glstate::State& mirror, const glstate::State& state);

/// Makes the mirror's current attributes equal to the context's, but for those that wait, and tells the sink.
template <class Sink>
void diff_current(glstate::State& mirror, const glstate::State& state, const Needs& needs, Sink& sink);

/// The same ids for the same values: call after both states followed the same commands.
void unify_id(glstate::State& mirror, const glstate::State& state, glstate::Category category);

namespace detail {

template <class Sink, class... E>
bool diff_attributes(glstate::ElementList<E...>, glstate::State& mirror, const glstate::State& state,
                     const Needs& needs, Sink& sink) {
    bool equal = true;
    const auto one = [&]<class Element>(unsigned i) {
        if (glstate::same(Element::ref(mirror, i), Element::ref(const_cast<glstate::State&>(state), i))) return;
        if (needs.waits(glstate::attribute_of_element<Element>(i))) {
            equal = false;
            return;
        }
        Element::ref(mirror, i) = Element::ref(state, i);
        sink.template set<Element>(i, Element::ref(state, i));
    };
    const auto each = [&]<class Element>() {
        for (unsigned i = 0; i < Element::count; ++i) one.template operator()<Element>(i);
    };
    (each.template operator()<E>(), ...);
    return equal;
}

}  // namespace detail

template <class Sink>
void diff_current(glstate::State& mirror, const glstate::State& state, const Needs& needs, Sink& sink) {
    constexpr auto kCurrent = static_cast<std::size_t>(glstate::Category::current);
    if (mirror.ids[kCurrent] == state.ids[kCurrent]) return;
    using List = glstate::CategoryElements<glstate::Category::current>::list;
    const bool equal = detail::diff_attributes(List{}, mirror, state, needs, sink);
    mirror.ids.take(kCurrent, equal ? state.ids[kCurrent] : glstate::next_value_id());
}

}  // namespace wall::client
