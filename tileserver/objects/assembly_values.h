// SPDX-License-Identifier: MIT
// The values of an assembly program while it is gone through, component by component. Besides what it is
// (position_builder.h), a component that the vertex moves remembers that it is a sum of products, a factor that the
// vertex does not move and a component that it does: four DP4, and MUL with three MAD, are then told to be the product
// of a matrix and a vector. Pure.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tileserver/objects/position_builder.h"

namespace wall::tileserver {

struct AssemblyTerm {
    PositionValue::Component factor, mover;
};

struct AssemblyScalar {
    PositionValue value{1, 1};  ///< unknown until it is written
    bool moves = false;         ///< with the vertex
    std::vector<AssemblyTerm> terms;

    PositionValue::Component component() const { return value[0]; }
    bool known() const { return value[0].step >= 0; }
};
using AssemblyVector = std::array<AssemblyScalar, 4>;

/// Its arithmetic.
class AssemblyValues {
public:
    /// `builder` outlives it.
    explicit AssemblyValues(PositionBuilder& builder);

    static AssemblyVector unknown(WhyUnknown why);
    AssemblyScalar constant(float value);
    /// Four components of a value from `first` on, `step` apart.
    static AssemblyVector pick(const PositionValue& value, unsigned first, unsigned step, bool moves);
    AssemblyScalar negated(const AssemblyScalar& a);
    AssemblyScalar sum(const AssemblyScalar& a, const AssemblyScalar& b);
    AssemblyScalar product(const AssemblyScalar& a, const AssemblyScalar& b);
    /// Of so many components.
    AssemblyScalar dot(const AssemblyVector& a, const AssemblyVector& b, unsigned components);
    /// All of it as one value: the product of a matrix and a vector if it is that.
    PositionValue whole(const AssemblyVector& vector);

private:
    std::vector<AssemblyTerm> terms_of(const AssemblyScalar& a) const;
    std::optional<PositionValue> matrix_product(const AssemblyVector& vector);

    PositionBuilder& builder_;
    PositionValue::Component zero_, one_;
};

}  // namespace wall::tileserver
