// SPDX-License-Identifier: MIT
// diff(from, to): the one operation behind state updates of nodes, soft context switches, recovery and migration
// (T3, T4, T5; DESIGN, section 1). A State belongs to one thread at a time.
//
// Lazy differences: what cannot matter now waits (T4), such as a blend function while blending is off; `when` of
// state.toml says what an element depends on. A category in which something waits keeps a value id of its own, so that
// the next difference looks at it again.
//
// Colour material (T3.2's cumulative attribute): while glColorMaterial tracking is on, the tracked material parameters
// follow the current colour in the driver, without anybody storing them. Their stored values mean nothing then and are
// not compared. When tracking ends or moves, store() gives them the current colour, by the same rule on both sides.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "gen/glstate/state.gen.h"

namespace wall::glstate {

/// A set of categories, one bit each.
using CategoryMask = std::uint32_t;
constexpr CategoryMask mask_of(Category c) { return CategoryMask{1} << static_cast<unsigned>(c); }
inline constexpr CategoryMask kSentCategories = (CategoryMask{1} << kSentCategoryCount) - 1;
/// What a tile's layer changes: applied per tile.
inline constexpr CategoryMask kLayerCategories = mask_of(Category::window) | mask_of(Category::raster);

/// Equal as bytes: NaN equals itself, -0 differs from 0.
template <class T>
bool same(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// Whether glColorMaterial (if enabled) drives the material parameter E of a face (0 front, 1 back).
template <class E>
bool tracks(const ColorMaterial& m, unsigned face) {
    if (m.face != GL_FRONT_AND_BACK && m.face != (face == 0 ? GLenum{GL_FRONT} : GLenum{GL_BACK})) return false;
    if constexpr (E::id == el::material_ambient::id) return m.mode == GL_AMBIENT || m.mode == GL_AMBIENT_AND_DIFFUSE;
    if constexpr (E::id == el::material_diffuse::id) return m.mode == GL_DIFFUSE || m.mode == GL_AMBIENT_AND_DIFFUSE;
    if constexpr (E::id == el::material_specular::id) return m.mode == GL_SPECULAR;
    if constexpr (E::id == el::material_emission::id) return m.mode == GL_EMISSION;
    return false;
}

/// Whether the stored value of an element means nothing now, because the current colour drives it.
template <class E>
bool follows_color(const State& s, [[maybe_unused]] unsigned i) {
    if constexpr (E::category == Category::material)
        return s.material.color_material_enabled && tracks<E>(s.material.color_material, i);
    return false;
}

/// The tracked material parameters become the current colour.
inline void adopt_current_color(State& s) {
    const auto adopt = [&s]<class E>(E) {
        for (unsigned face = 0; face < 2; ++face)
            if (follows_color<E>(s, face)) E::ref(s, face) = s.current.color;
    };
    adopt(el::material_ambient{});
    adopt(el::material_diffuse{});
    adopt(el::material_specular{});
    adopt(el::material_emission{});
}

/// Stores a value without a new value id; the caller owes one.
template <class E>
void store(State& s, unsigned i, const typename E::type& v) {
    if constexpr (E::id == el::color_material::id || E::id == el::color_material_enabled::id) adopt_current_color(s);
    E::ref(s, i) = v;
}

/// False if the value was that already; else stores it, and its category has a new value id.
template <class E>
bool assign(State& s, unsigned i, const typename E::type& v) {
    if (same(E::ref(static_cast<const State&>(s), i), v)) return false;
    store<E>(s, i, v);
    s.ids.renew(static_cast<std::size_t>(E::category));
    return true;
}

namespace detail {

// What was found: of several, all bits.
inline constexpr unsigned kTold = 1, kWaits = 2;

template <class E, bool Lazy, class Sink>
unsigned diff_value(State& from, const State& to, unsigned i, Sink& sink) {
    if (same(E::ref(static_cast<const State&>(from), i), E::ref(to, i))) [[likely]]
        return 0;
    if (follows_color<E>(to, i)) return 0;
    if constexpr (Lazy && E::waits)
        if (!E::matters(to, i)) return kWaits;
    const typename E::type v = E::ref(to, i);
    store<E>(from, i, v);
    sink.template set<E>(i, v);
    return kTold;
}

template <class E, bool Lazy, class Sink>
unsigned diff_element(State& from, const State& to, Sink& sink) {
    if constexpr (E::count > 1) {
        if (std::memcmp(&E::ref(static_cast<const State&>(from), 0), &E::ref(to, 0),
                        sizeof(typename E::type) * E::count) == 0) [[likely]]
            return 0;
    }
    unsigned found = 0;
    for (unsigned i = 0; i < E::count; ++i) found |= diff_value<E, Lazy>(from, to, i, sink);
    return found;
}

template <bool Lazy, class Sink, class... E>
unsigned diff_list(ElementList<E...>, State& from, const State& to, Sink& sink) {
    return (diff_element<E, Lazy>(from, to, sink) | ... | 0u);
}

// Where To is State, equal categories get one value id, that of `from`. Out of line: what a difference runs through is
// then only the code of what may differ, and a processor between two scenes of llvmpipe's has to fetch all of it.
template <std::size_t C, bool Lazy, class To, class Sink>
[[gnu::noinline]] void diff_of(State& from, To& to, Sink& sink) {
    const unsigned found = diff_list<Lazy>(typename CategoryElements<static_cast<Category>(C)>::list{}, from, to, sink);
    if constexpr (!std::is_const_v<To>) {
        if (found == 0) {
            to.ids.take(C, from.ids[C]);
            return;
        }
    }
    if (Lazy && (found & kWaits) != 0) {
        if ((found & kTold) != 0) from.ids.renew(C);
        return;
    }
    from.ids.take(C, to.ids[C]);
}

/// Those of `wanted` whose value ids differ.
inline CategoryMask differing(CategoryMask wanted, const State& a, const State& b) {
    CategoryMask out = 0;
    for (std::size_t c = 0; c < kCategoryCount; ++c) out |= CategoryMask{a.ids[c] != b.ids[c]} << c;
    return out & wanted;
}

// The function of category C, none where Mask does not have it.
template <CategoryMask Mask, std::size_t C, bool Lazy, class To, class Sink>
constexpr auto diff_function() -> void (*)(State&, To&, Sink&) {
    if constexpr ((Mask >> C & 1) != 0) return diff_of<C, Lazy, To, Sink>;
    else return nullptr;
}

// Mask: those that `wanted` may have.
template <CategoryMask Mask, bool Lazy = false, class To, class Sink, std::size_t... C>
void diff_categories(CategoryMask wanted, State& from, To& to, Sink& sink, std::index_sequence<C...>) {
    static constexpr std::array kFunctions = {diff_function<Mask, C, Lazy, To, Sink>()...};
    for (CategoryMask rest = differing(wanted & Mask, from, to); rest != 0; rest &= rest - 1)
        kFunctions[static_cast<std::size_t>(std::countr_zero(rest))](from, to, sink);
}

using TwoIds [[gnu::vector_size(16)]] = std::uint64_t;

/// Bits in which the ids of the categories 2 * Pair and 2 * Pair + 1 differ, if they are in Mask.
template <CategoryMask Mask, std::size_t Pair>
TwoIds differing_bits(const State& a, const State& b) {
    constexpr auto ones = [](std::size_t c) { return (Mask >> c & 1) != 0 ? ~std::uint64_t{0} : 0; };
    if constexpr ((Mask >> 2 * Pair & 3) == 0) return TwoIds{};
    TwoIds ids_a, ids_b;
    std::memcpy(&ids_a, &a.ids[2 * Pair], sizeof ids_a);
    std::memcpy(&ids_b, &b.ids[2 * Pair], sizeof ids_b);
    return (ids_a ^ ids_b) & TwoIds{ones(2 * Pair), ones(2 * Pair + 1)};
}

template <CategoryMask Mask, std::size_t... Pair>
bool same_pairs(const State& a, const State& b, std::index_sequence<Pair...>) {
    const TwoIds different = (differing_bits<Mask, Pair>(a, b) | ...);
    return (different[0] | different[1]) == 0;
}

}  // namespace detail

/// Makes `from` equal to `to` in the categories of Mask, telling `sink.template set<E>(i, value)` each value that
/// changed.
template <CategoryMask Mask = kSentCategories, class Sink>
void diff(State& from, const State& to, Sink&& sink) {
    detail::diff_categories<Mask>(Mask, from, to, sink, std::make_index_sequence<kCategoryCount>{});
}

/// Whether all categories of Mask have the same value ids: no branch until the end, two categories an instruction.
template <CategoryMask Mask>
bool same_ids(const State& a, const State& b) {
    constexpr std::size_t kPairs = (kSentCategoryCount + 1) / 2;
    static_assert(2 * kPairs <= kCategoryCount && (Mask & ~kSentCategories) == 0);
    return detail::same_pairs<Mask>(a, b, std::make_index_sequence<kPairs>{});
}

/// diff() for a receiver that goes between several states (T5): a category of `to` that proves equal takes the value id
/// of `from`, so that it is compared by value once and costs nothing from then on, whoever it is compared with.
template <CategoryMask Mask = kSentCategories, class Sink>
void diff_and_unify(State& from, State& to, Sink&& sink) {
    if (same_ids<Mask>(from, to)) return;
    detail::diff_categories<Mask>(Mask, from, to, sink, std::make_index_sequence<kCategoryCount>{});
}

/// Two states hold equal values in these categories; from now on by the same ids.
inline void unify_ids(CategoryMask categories, State& a, const State& b) {
    for (std::size_t c = 0; c < kCategoryCount; ++c)
        if ((categories >> c & 1) != 0) a.ids.take(c, b.ids[c]);
}

/// diff() with the categories chosen at run time.
template <class Sink>
void diff(CategoryMask wanted, State& from, const State& to, Sink&& sink) {
    detail::diff_categories<kSentCategories>(wanted, from, to, sink, std::make_index_sequence<kCategoryCount>{});
}

/// The same, but for what cannot matter with the state of `to`: that is told when it can.
template <class Sink>
void diff_lazily(CategoryMask wanted, State& from, const State& to, Sink&& sink) {
    detail::diff_categories<kSentCategories, true>(wanted, from, to, sink, std::make_index_sequence<kCategoryCount>{});
}

template <Category C, class Sink>
void diff_category(State& from, const State& to, Sink&& sink) {
    constexpr auto kId = static_cast<std::size_t>(C);
    if (from.ids[kId] != to.ids[kId]) detail::diff_of<kId, false>(from, to, sink);
}

namespace detail {
template <class F, class... E>
void for_each_element(ElementList<E...>, F& f) {
    (f.template operator()<E>(), ...);
}
template <class F, std::size_t... C>
void for_each_category(F& f, std::index_sequence<C...>) {
    (for_each_element(typename CategoryElements<static_cast<Category>(C)>::list{}, f), ...);
}
}  // namespace detail

/// Calls `f.template operator()<E>()` for every element, `local` ones included.
template <class F>
void for_each_element(F&& f) {
    detail::for_each_category(f, std::make_index_sequence<kCategoryCount>{});
}

/// Calls `f.template operator()<E>(i)` for every value that glPushAttrib(mask) saves.
template <class F>
void for_each_in_group(GLbitfield mask, F&& f) {
    for_each_element([&]<class E>() {
        if (E::groups & mask)
            for (unsigned i = 0; i < E::count; ++i) f.template operator()<E>(i);
    });
}

/// Does the same for glPushClientAttrib.
template <class F>
void for_each_in_client_group(GLbitfield mask, F&& f) {
    for_each_element([&]<class E>() {
        if (E::client_groups & mask)
            for (unsigned i = 0; i < E::count; ++i) f.template operator()<E>(i);
    });
}

}  // namespace wall::glstate
