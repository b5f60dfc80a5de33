// SPDX-License-Identifier: MIT
#include "common/glstate/queries.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "common/glstate/elements.h"

namespace wall::glstate {
namespace {

template <class T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

template <class Out>
Out saturated(double value) {
    if (!(value > static_cast<double>(std::numeric_limits<Out>::min()))) return std::numeric_limits<Out>::min();
    if (value >= static_cast<double>(std::numeric_limits<Out>::max())) return std::numeric_limits<Out>::max();
    return static_cast<Out>(value);
}

template <class Out>
Out from_real(double value) {
    if constexpr (std::is_same_v<Out, GLboolean>) return value != 0 ? GL_TRUE : GL_FALSE;
    else if constexpr (std::is_integral_v<Out>) return saturated<Out>(std::round(value));
    else return static_cast<Out>(value);
}

/// [-1, 1] maps linearly to the integers' range. What lies outside becomes the least integer, as Mesa's conversion
/// does.
template <class Out>
Out from_normalized(double value) {
    if constexpr (std::is_same_v<Out, GLint> || std::is_same_v<Out, GLint64>)
        return static_cast<Out>(std::abs(value) <= 1 ? static_cast<GLint>(2147483647.0 * value)
                                                     : std::numeric_limits<GLint>::min());
    else return from_real<Out>(value);
}

template <class Out>
Out from_integer(std::int64_t value) {
    if constexpr (std::is_same_v<Out, GLboolean>) return value != 0 ? GL_TRUE : GL_FALSE;
    else return static_cast<Out>(value);
}

template <class Out>
Out component(const std::byte* at, ValueKind kind, unsigned i) {
    switch (kind) {
        case ValueKind::real: return from_real<Out>(load<float>(at + 4 * i));
        case ValueKind::normalized: return from_normalized<Out>(load<float>(at + 4 * i));
        case ValueKind::real64: return from_real<Out>(load<double>(at + 8 * i));
        case ValueKind::normalized64: return from_normalized<Out>(load<double>(at + 8 * i));
        case ValueKind::first_bit: return from_integer<Out>(load<std::uint32_t>(at + 4 * i) & 1);
        case ValueKind::pointer: return from_integer<Out>(load<std::int64_t>(at + 8 * i));
        case ValueKind::unsigned_integer:
            if constexpr (std::is_same_v<Out, GLint64>) return from_integer<Out>(load<std::uint32_t>(at + 4 * i));
            else return from_integer<Out>(load<std::int32_t>(at + 4 * i));  // as Mesa: masks of all ones are -1
        default: return from_integer<Out>(load<std::int32_t>(at + 4 * i));
    }
}

template <class Entry, class Key>
const Entry* find_sorted(std::span<const Entry> entries, GLenum word, Key Entry::*key) {
    const auto at =
        std::lower_bound(entries.begin(), entries.end(), word, [key](const Entry& e, GLenum w) { return e.*key < w; });
    return at != entries.end() && (*at).*key == word ? &*at : nullptr;
}

}  // namespace

const GetEntry* find_get(GLenum pname) { return find_sorted(kGetEntries, pname, &GetEntry::pname); }
const CapEntry* find_cap(GLenum cap) { return find_sorted(kCapEntries, cap, &CapEntry::cap); }

const ParamEntry* find_param(ParamFamily family, GLenum target, GLenum pname) {
    for (const ParamEntry& e : kParamEntries)
        if (e.family == family && e.target == target && e.pname == pname) return &e;
    return nullptr;
}

template <class Out>
void read_components(const State& state, std::uint32_t id, std::uint32_t offset, ValueKind kind, unsigned count,
                     Out* out) {
    const auto* at = reinterpret_cast<const std::byte*>(&state) + element_offset(id) + offset;
    for (unsigned i = 0; i < count; ++i) out[i] = component<Out>(at, kind, i);
}

template void read_components(const State&, std::uint32_t, std::uint32_t, ValueKind, unsigned, GLboolean*);
template void read_components(const State&, std::uint32_t, std::uint32_t, ValueKind, unsigned, GLint*);
template void read_components(const State&, std::uint32_t, std::uint32_t, ValueKind, unsigned, GLint64*);
template void read_components(const State&, std::uint32_t, std::uint32_t, ValueKind, unsigned, GLfloat*);
template void read_components(const State&, std::uint32_t, std::uint32_t, ValueKind, unsigned, GLdouble*);

}  // namespace wall::glstate
