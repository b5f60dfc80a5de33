// SPDX-License-Identifier: MIT
#include "tileserver/objects/position_builder.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace wall::tileserver {
namespace {

using glapi::PositionOp;
using glapi::PositionStep;

/// While a shader is gone through, before what nobody needs is dropped.
constexpr std::size_t kMostSteps = 4096;
constexpr std::int32_t kNone = -1, kSeveral = -2;

template <class T>
std::uint32_t index_in(std::vector<T>& list, const T& item) {
    const auto found = std::ranges::find(list, item);
    if (found != list.end()) return static_cast<std::uint32_t>(found - list.begin());
    list.push_back(item);
    return static_cast<std::uint32_t>(list.size() - 1);
}

PositionStep make_step(PositionOp op, unsigned columns, unsigned rows, std::vector<std::uint32_t> operands) {
    return {op, static_cast<std::uint8_t>(columns), static_cast<std::uint8_t>(rows), std::move(operands)};
}

}  // namespace

const char* describe(WhyUnknown why) {
    switch (why) {
        case WhyUnknown::not_written: return "not written";
        case WhyUnknown::not_affine: return "not an affine function of the vertex";
        case WhyUnknown::two_attributes: return "depends on several attributes";
        case WhyUnknown::depends_on_flow: return "depends on branches or loops";
        case WhyUnknown::not_a_float: return "depends on what is no float of full precision";
        case WhyUnknown::in_a_block: return "depends on a block of uniforms";
        case WhyUnknown::other_state: return "depends on state that is not followed";
        case WhyUnknown::too_long: return "too long";
    }
    return "";
}

PositionValue::PositionValue(unsigned columns, unsigned rows, WhyUnknown why)
    : columns_(static_cast<std::uint8_t>(columns)), rows_(static_cast<std::uint8_t>(rows)) {
    for (unsigned i = 0; i < size(); ++i) components_[i] = {-1, static_cast<std::uint8_t>(why)};
}

std::optional<WhyUnknown> PositionValue::unknown() const {
    for (unsigned i = 0; i < size(); ++i)
        if (components_[i].step < 0) return static_cast<WhyUnknown>(components_[i].index);
    return size() == 0 ? std::optional(WhyUnknown::not_a_float) : std::nullopt;
}

// ---- steps ----

std::int32_t PositionBuilder::add(PositionStep step, std::int32_t attribute) {
    Key key{step.op, step.columns * 8u + step.rows, step.operands};
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    if (steps_.size() >= kMostSteps) return kNone;
    const auto index = static_cast<std::int32_t>(steps_.size());
    steps_.push_back({std::move(step), attribute});
    known_.emplace(std::move(key), index);
    return index;
}

PositionValue PositionBuilder::value_of(PositionStep step, std::int32_t attribute) {
    PositionValue out(step.columns, step.rows, WhyUnknown::too_long);
    const std::int32_t index = add(std::move(step), attribute);
    if (index < 0) return out;
    for (unsigned i = 0; i < out.size(); ++i) out[i] = {index, static_cast<std::uint8_t>(i)};
    return out;
}

std::int32_t PositionBuilder::step_of(const PositionValue& value) {
    const std::int32_t first = value[0].step;
    const PositionStep& step = steps_[static_cast<std::size_t>(first)].step;
    bool whole = step.columns == value.columns() && step.rows == value.rows();
    std::vector<std::uint32_t> operands;
    for (unsigned i = 0; i < value.size(); ++i) {
        whole = whole && value[i].step == first && value[i].index == i;
        operands.push_back(static_cast<std::uint32_t>(value[i].step));
        operands.push_back(value[i].index);
    }
    if (whole) return first;
    return add(make_step(PositionOp::pick, value.columns(), value.rows(), std::move(operands)), attribute_of(value));
}

/// kSeveral: two of them.
std::int32_t PositionBuilder::attribute_of(const PositionValue& value) const {
    std::int32_t found = kNoAttribute;
    for (unsigned i = 0; i < value.size(); ++i) {
        const std::int32_t other = steps_[static_cast<std::size_t>(value[i].step)].attribute;
        if (other == kNoAttribute || other == found) continue;
        if (found != kNoAttribute) return kSeveral;
        found = other;
    }
    return found;
}

std::optional<WhyUnknown> PositionBuilder::depend(Op op, const PositionValue& a, const PositionValue& b,
                                                  std::int32_t& attribute) const {
    if (const auto why = a.unknown()) return why;
    if (const auto why = b.unknown()) return why;
    const std::int32_t left = attribute_of(a), right = attribute_of(b);
    const bool both = left != kNoAttribute && right != kNoAttribute;
    if (left == kSeveral || right == kSeveral || (both && left != right)) return WhyUnknown::two_attributes;
    const bool sum = op == Op::add || op == Op::subtract;
    if ((both && !sum) || (op == Op::divide && right != kNoAttribute)) return WhyUnknown::not_affine;
    attribute = both || left != kNoAttribute ? left : right;
    return std::nullopt;
}

// ---- operations ----

PositionValue PositionBuilder::constant(unsigned columns, unsigned rows, std::span<const float> components) {
    std::vector<std::uint32_t> operands;
    for (const float component : components) operands.push_back(std::bit_cast<std::uint32_t>(component));
    return value_of(make_step(Op::constant, columns, rows, std::move(operands)), kNoAttribute);
}

PositionValue PositionBuilder::uniform(const std::string& name, std::uint32_t element, unsigned columns,
                                       unsigned rows) {
    const std::uint32_t index = index_in(uniforms_, glapi::PositionUniform{name, element});
    return value_of(make_step(Op::uniform, columns, rows, {index}), kNoAttribute);
}

PositionValue PositionBuilder::built_in(glapi::BuiltInMatrix which) {
    return value_of(make_step(Op::built_in, 4, 4, {static_cast<std::uint32_t>(which)}), kNoAttribute);
}

PositionValue PositionBuilder::attribute(const std::string& name, unsigned rows) {
    const std::uint32_t index = index_in(attributes_, name);  // no operand in the end: a program has only one
    return value_of(make_step(Op::attribute, 1, rows, {index}), static_cast<std::int32_t>(index));
}

PositionValue PositionBuilder::each(Op op, const PositionValue& a, const PositionValue& b) {
    const PositionValue& shape = a.scalar() ? b : a;
    std::int32_t attribute = kNoAttribute;
    if (!a.scalar() && !b.scalar() && !a.same_shape(b)) return {shape.columns(), shape.rows(), WhyUnknown::not_a_float};
    if (const auto why = depend(op, a, b, attribute)) return {shape.columns(), shape.rows(), *why};
    const std::int32_t left = step_of(a), right = step_of(b);
    if (left < 0 || right < 0) return {shape.columns(), shape.rows(), WhyUnknown::too_long};
    return value_of(make_step(op, shape.columns(), shape.rows(),
                              {static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(right)}),
                    attribute);
}

PositionValue PositionBuilder::product(const PositionValue& a, const PositionValue& b) {
    const bool row = a.columns() == 1;
    const unsigned columns = b.columns(), rows = row ? 1 : a.rows();
    // A row times a matrix is a vector again.
    PositionValue unknown(row && columns > 1 ? 1 : columns, row && columns > 1 ? columns : rows);
    std::int32_t attribute = kNoAttribute;
    const bool fits = (row ? a.rows() : a.columns()) == b.rows();
    const auto why = fits ? depend(Op::product, a, b, attribute) : WhyUnknown::not_a_float;
    const std::int32_t left = why ? kNone : step_of(a), right = why ? kNone : step_of(b);
    if (left < 0 || right < 0) return {unknown.columns(), unknown.rows(), why.value_or(WhyUnknown::too_long)};
    return value_of(make_step(Op::product, unknown.columns(), unknown.rows(),
                              {static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(right)}),
                    attribute);
}

PositionValue PositionBuilder::inverse(const PositionValue& matrix) {
    auto why = matrix.unknown();
    if (!why && (attribute_of(matrix) != kNoAttribute || matrix.columns() != matrix.rows()))
        why = WhyUnknown::not_affine;
    const std::int32_t step = why ? kNone : step_of(matrix);
    if (step < 0) return {matrix.columns(), matrix.rows(), why.value_or(WhyUnknown::too_long)};
    return value_of(make_step(Op::inverse, matrix.columns(), matrix.rows(), {static_cast<std::uint32_t>(step)}),
                    kNoAttribute);
}

PositionValue PositionBuilder::transpose(const PositionValue& matrix) {
    PositionValue out(matrix.rows(), matrix.columns());
    for (unsigned column = 0; column < matrix.columns(); ++column)
        for (unsigned row = 0; row < matrix.rows(); ++row)
            out[row * out.rows() + column] = matrix[column * matrix.rows() + row];
    return out;
}

// ---- the result ----

namespace {

/// Calls use(operand) for each operand that is a step.
template <class Operands, class Use>
void for_each_step(PositionOp op, Operands& operands, Use&& use) {
    const bool leaf = op < PositionOp::pick;
    const std::size_t stride = op == PositionOp::pick ? 2 : 1;
    for (std::size_t i = 0; !leaf && i < operands.size(); i += stride) use(operands[i]);
}

}  // namespace

std::optional<WhyUnknown> PositionBuilder::finish(const PositionValue& position, glapi::PositionProgram& out) const {
    PositionBuilder last = *this;
    PositionValue whole = position;
    const bool depth = position[2].step >= 0;
    constexpr float kZero[] = {0};
    if (!depth) whole[2] = last.constant(1, 1, kZero)[0];
    if (const auto why = whole.unknown()) return why;
    const std::int32_t attribute = last.attribute_of(whole);
    if (attribute == kSeveral) return WhyUnknown::two_attributes;
    if (attribute == kNoAttribute) return WhyUnknown::not_affine;  // a point, whatever is drawn
    const std::int32_t result = last.step_of(whole);
    if (result < 0) return WhyUnknown::too_long;

    std::vector<std::uint32_t> place(static_cast<std::size_t>(result) + 1, 0);  // of a step in the program; 0: unused
    place.back() = 1;
    for (std::size_t i = place.size(); i-- > 0;) {
        const PositionStep& step = last.steps_[i].step;
        if (place[i] != 0) for_each_step(step.op, step.operands, [&](std::uint32_t operand) { place[operand] = 1; });
    }
    out = {};
    out.attribute = attributes_[static_cast<std::size_t>(attribute)];
    out.depth = depth;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] == 0) continue;
        PositionStep step = last.steps_[i].step;
        for_each_step(step.op, step.operands, [&](std::uint32_t& operand) { operand = place[operand]; });
        if (step.op == Op::uniform) step.operands[0] = index_in(out.uniforms, last.uniforms_[step.operands[0]]);
        if (step.op == Op::attribute) step.operands.clear();
        place[i] = static_cast<std::uint32_t>(out.steps.size());
        out.steps.push_back(std::move(step));
    }
    if (out.steps.size() <= glapi::kMostPositionSteps) return std::nullopt;
    out = {};
    return WhyUnknown::too_long;
}

}  // namespace wall::tileserver
