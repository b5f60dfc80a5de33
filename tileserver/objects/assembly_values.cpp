// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_values.h"

#include <algorithm>
#include <utility>

namespace wall::tileserver {
namespace {

using glapi::PositionOp;
using Component = PositionValue::Component;

constexpr std::size_t kMostTerms = 4;

PositionValue of_component(Component component) {
    PositionValue out(1, 1);
    out[0] = component;
    return out;
}

PositionValue gathered(const AssemblyVector& vector, unsigned components) {
    PositionValue out(1, components);
    for (unsigned i = 0; i < components; ++i) out[i] = vector[i].component();
    return out;
}

bool before(Component a, Component b) { return std::pair(a.step, a.index) < std::pair(b.step, b.index); }

/// What the terms of all components move with, in order; too many: they are no matrix times a vector.
std::optional<std::vector<Component>> movers_of(const std::array<std::vector<AssemblyTerm>, 4>& rows) {
    std::vector<Component> movers;
    for (const auto& row : rows)
        for (const AssemblyTerm& term : row)
            if (std::ranges::find(movers, term.mover) == movers.end()) movers.push_back(term.mover);
    if (movers.size() > kMostTerms) return std::nullopt;
    std::ranges::sort(movers, before);
    return movers;
}

}  // namespace

AssemblyValues::AssemblyValues(PositionBuilder& builder) : builder_(builder) {
    zero_ = constant(0).component();
    one_ = constant(1).component();
}

AssemblyVector AssemblyValues::unknown(WhyUnknown why) {
    AssemblyVector out;
    for (AssemblyScalar& scalar : out) scalar.value = PositionValue(1, 1, why);
    return out;
}

AssemblyScalar AssemblyValues::constant(float value) { return {builder_.constant(1, 1, {&value, 1}), false, {}}; }

AssemblyVector AssemblyValues::pick(const PositionValue& value, unsigned first, unsigned step, bool moves) {
    AssemblyVector out;
    for (unsigned i = 0; i < out.size(); ++i) out[i] = {of_component(value[first + i * step]), moves, {}};
    return out;
}

/// A sum that is not known any more is a term by itself.
std::vector<AssemblyTerm> AssemblyValues::terms_of(const AssemblyScalar& a) const {
    if (!a.moves) return {{a.component(), one_}};
    if (a.terms.empty()) return {{one_, a.component()}};
    return a.terms;
}

AssemblyScalar AssemblyValues::negated(const AssemblyScalar& a) { return product(constant(-1), a); }

AssemblyScalar AssemblyValues::sum(const AssemblyScalar& a, const AssemblyScalar& b) {
    AssemblyScalar out{builder_.each(PositionOp::add, a.value, b.value), a.moves || b.moves, {}};
    if (!out.known() || !out.moves) return out;
    out.terms = terms_of(a);
    for (const AssemblyTerm& term : terms_of(b)) {
        if (std::ranges::find(out.terms, term.mover, &AssemblyTerm::mover) != out.terms.end()) {
            out.terms.clear();
            return out;
        }
        out.terms.push_back(term);
    }
    if (out.terms.size() > kMostTerms) out.terms.clear();
    return out;
}

AssemblyScalar AssemblyValues::product(const AssemblyScalar& a, const AssemblyScalar& b) {
    AssemblyScalar out{builder_.each(PositionOp::multiply, a.value, b.value), a.moves || b.moves, {}};
    if (!out.known() || a.moves == b.moves) return out;
    out.terms = {{(a.moves ? b : a).component(), (a.moves ? a : b).component()}};
    return out;
}

AssemblyScalar AssemblyValues::dot(const AssemblyVector& a, const AssemblyVector& b, unsigned components) {
    const auto moves = [&](const AssemblyVector& v) {
        return std::any_of(v.begin(), v.begin() + components, [](const AssemblyScalar& s) { return s.moves; });
    };
    const bool left = moves(a), right = moves(b);
    AssemblyScalar out{builder_.product(gathered(a, components), gathered(b, components)), left || right, {}};
    if (!out.known() || left == right) return out;
    for (unsigned i = 0; i < components; ++i)
        out.terms.push_back({(left ? b : a)[i].component(), (left ? a : b)[i].component()});
    return out;
}

std::optional<PositionValue> AssemblyValues::matrix_product(const AssemblyVector& vector) {
    std::array<std::vector<AssemblyTerm>, 4> rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!vector[i].known()) return std::nullopt;
        rows[i] = terms_of(vector[i]);
    }
    const auto movers = movers_of(rows);
    if (!movers) return std::nullopt;
    PositionValue matrix(4, 4), moved(1, 4);
    for (unsigned column = 0; column < 4; ++column) {
        const bool there = column < movers->size();
        moved[column] = there ? (*movers)[column] : zero_;
        for (unsigned row = 0; row < 4; ++row) {
            Component factor = zero_;
            bool found = false;
            for (const AssemblyTerm& term : rows[row]) {
                if (!there || term.mover != moved[column]) continue;
                if (std::exchange(found, true)) return std::nullopt;  // of a dot product with one component twice
                factor = term.factor;
            }
            matrix[4 * column + row] = factor;
        }
    }
    PositionValue out = builder_.product(matrix, moved);
    return out.unknown() ? std::nullopt : std::optional(out);
}

PositionValue AssemblyValues::whole(const AssemblyVector& vector) {
    if (auto product = matrix_product(vector)) return *product;
    return gathered(vector, 4);
}

}  // namespace wall::tileserver
