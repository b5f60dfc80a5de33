// SPDX-License-Identifier: MIT
#include "common/glapi/position_program.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace wall::glapi {
namespace {

constexpr std::size_t kMostComponents = 16, kVectorComponents = 4;

// ---- checking ----

struct Shape {
    std::uint8_t columns, rows;
    bool operator==(const Shape&) const = default;
    bool scalar() const { return columns == 1 && rows == 1; }
    bool vector() const { return columns == 1; }
};

Shape shape_of(const PositionStep& step) { return {step.columns, step.rows}; }

/// Of the value of a product; nothing: these do not go together.
std::optional<Shape> product_shape(Shape a, Shape b) {
    if (a.vector() && b.vector()) return a == b ? std::optional(Shape{1, 1}) : std::nullopt;
    if (a.vector()) return a.rows == b.rows ? std::optional(Shape{1, b.columns}) : std::nullopt;
    return a.columns == b.rows ? std::optional(Shape{b.columns, a.rows}) : std::nullopt;
}

/// Goes over the steps once; of each it is then known whether the vertex moves it.
class Check {
public:
    explicit Check(const PositionProgram& program) : program_(program) {}

    bool run() {
        const auto& steps = program_.steps;
        if (steps.size() > kMostPositionSteps) return false;
        for (const PositionStep& step : steps) {
            const auto moves = moved_by_vertex(step);
            if (!moves || step.columns == 0 || step.columns > 4 || step.rows == 0 || step.rows > 4) return false;
            if (*moves && step.columns != 1) return false;
            moves_.push_back(*moves);
        }
        return steps.empty() || shape_of(steps.back()) == Shape{1, kVectorComponents};
    }

private:
    bool has_operands(const PositionStep& step, std::size_t count) const { return step.operands.size() == count; }
    bool is_earlier(std::uint32_t step) const { return step < moves_.size(); }
    Shape shape(std::uint32_t step) const { return shape_of(program_.steps[step]); }

    /// Nothing: it has no meaning.
    std::optional<bool> moved_by_vertex(const PositionStep& step) const {
        switch (step.op) {
            case PositionOp::constant:
                return has_operands(step, step.components()) ? std::optional(false) : std::nullopt;
            case PositionOp::uniform:
                return has_operands(step, 1) && step.operands[0] < program_.uniforms.size() ? std::optional(false)
                                                                                            : std::nullopt;
            case PositionOp::built_in: {
                const bool good = has_operands(step, 1) && shape_of(step) == Shape{4, 4} &&
                                  step.operands[0] <= static_cast<std::uint32_t>(BuiltInMatrix::modelview_projection);
                return good ? std::optional(false) : std::nullopt;
            }
            case PositionOp::attribute: return has_operands(step, 0) ? std::optional(true) : std::nullopt;
            case PositionOp::pick: return of_pick(step);
            case PositionOp::inverse: {
                const bool good = has_operands(step, 1) && is_earlier(step.operands[0]) && !moves_[step.operands[0]] &&
                                  step.columns == step.rows && shape(step.operands[0]) == shape_of(step);
                return good ? std::optional(false) : std::nullopt;
            }
            default: return of_two(step);
        }
    }
    std::optional<bool> of_pick(const PositionStep& step) const {
        if (!has_operands(step, 2 * step.components())) return std::nullopt;
        bool moves = false;
        for (std::size_t i = 0; i < step.operands.size(); i += 2) {
            if (!is_earlier(step.operands[i])) return std::nullopt;
            if (step.operands[i + 1] >= program_.steps[step.operands[i]].components()) return std::nullopt;
            moves = moves || moves_[step.operands[i]];
        }
        return moves;
    }
    std::optional<bool> of_two(const PositionStep& step) const {
        if (step.op > PositionOp::product || !has_operands(step, 2)) return std::nullopt;
        const std::uint32_t a = step.operands[0], b = step.operands[1];
        if (!is_earlier(a) || !is_earlier(b)) return std::nullopt;
        const bool sum = step.op == PositionOp::add || step.op == PositionOp::subtract;
        if ((!sum && moves_[a] && moves_[b]) || (step.op == PositionOp::divide && moves_[b])) return std::nullopt;
        const Shape left = shape(a), right = shape(b);
        const bool fits = step.op == PositionOp::product ? product_shape(left, right) == shape_of(step)
                          : left.scalar()                ? right == shape_of(step)
                                                         : left == shape_of(step) && (right == left || right.scalar());
        return fits ? std::optional(moves_[a] || moves_[b]) : std::nullopt;
    }

    const PositionProgram& program_;
    std::vector<bool> moves_;  ///< by step
};

// ---- evaluation ----

/// A value as a function of the attribute. Only vectors depend on it.
struct Value {
    std::array<float, kMostComponents> constant{};
    std::array<std::array<float, 4>, kVectorComponents> slope{};  ///< of each component, to each of x, y, z and w
};

/// The terms of one component: its slopes, and what it is where the attribute is 0.
struct Component {
    static constexpr std::size_t kConstant = 4;
    std::array<float, 5> terms{};
};

Component component(const Value& value, std::size_t i) {
    Component out{{0, 0, 0, 0, value.constant[i]}};
    if (i < kVectorComponents) std::ranges::copy(value.slope[i], out.terms.begin());
    return out;
}

void put(Value& value, std::size_t i, const Component& c) {
    value.constant[i] = c.terms[Component::kConstant];
    if (i < kVectorComponents) std::copy_n(c.terms.begin(), 4, value.slope[i].begin());
}

template <class F>
Component combine(const Component& a, const Component& b, F&& f) {
    Component out;
    for (std::size_t i = 0; i < out.terms.size(); ++i) out.terms[i] = f(a.terms[i], b.terms[i]);
    return out;
}

/// One of them does not depend on the vertex, so that its slopes are 0.
Component times(const Component& a, const Component& b) {
    Component out{};
    const float x = a.terms[Component::kConstant], y = b.terms[Component::kConstant];
    for (std::size_t i = 0; i < Component::kConstant; ++i) out.terms[i] = a.terms[i] * y + x * b.terms[i];
    out.terms[Component::kConstant] = x * y;
    return out;
}

Component divided(const Component& a, float by) {
    Component out = a;
    for (float& term : out.terms) term /= by;
    return out;
}

/// By Gauss and Jordan with pivots; of a singular matrix it is no numbers.
std::array<float, kMostComponents> inverse(const std::array<float, kMostComponents>& matrix, std::size_t n) {
    double work[4][8] = {};
    for (std::size_t row = 0; row < n; ++row) {
        for (std::size_t column = 0; column < n; ++column)
            work[row][column] = static_cast<double>(matrix[column * n + row]);
        work[row][n + row] = 1;
    }
    for (std::size_t step = 0; step < n; ++step) {
        std::size_t pivot = step;
        for (std::size_t row = step + 1; row < n; ++row)
            if (std::abs(work[row][step]) > std::abs(work[pivot][step])) pivot = row;
        std::swap(work[step], work[pivot]);
        const double by = work[step][step];
        for (double& x : work[step]) x /= by;
        for (std::size_t row = 0; row < n; ++row) {
            const double factor = row == step ? 0 : work[row][step];
            if (factor == 0) continue;
            for (std::size_t column = 0; column < 2 * n; ++column) work[row][column] -= factor * work[step][column];
        }
    }
    std::array<float, kMostComponents> out{};
    for (std::size_t row = 0; row < n; ++row)
        for (std::size_t column = 0; column < n; ++column)
            out[column * n + row] = static_cast<float>(work[row][n + column]);
    return out;
}

class Evaluation {
public:
    Evaluation(const PositionProgram& program, const PositionValues& values) : program_(program), given_(values) {}

    std::optional<PositionTransform> run() {
        if (!program_.known() || given_.uniforms.size() != program_.uniforms.size()) return std::nullopt;
        values_.reserve(program_.steps.size());
        for (const PositionStep& step : program_.steps) {
            Value value;
            if (!find(step, value)) return std::nullopt;
            values_.push_back(value);
        }
        PositionTransform out;
        bool finite = true;
        for (std::size_t row = 0; row < kVectorComponents; ++row) {
            const Component c = component(values_.back(), row);
            for (std::size_t column = 0; column < 4; ++column) out.linear[4 * column + row] = c.terms[column];
            out.constant[row] = c.terms[Component::kConstant];
            for (const float term : c.terms) finite = finite && std::isfinite(term);
        }
        return finite ? std::optional(out) : std::nullopt;
    }

private:
    bool find(const PositionStep& step, Value& out) const {
        switch (step.op) {
            case PositionOp::constant:
                std::ranges::transform(step.operands, out.constant.begin(),
                                       [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
                break;
            case PositionOp::uniform: {
                const auto given = given_.uniforms[step.operands[0]];
                if (given.size() != step.components()) return false;
                std::ranges::copy(given, out.constant.begin());
                break;
            }
            case PositionOp::built_in: out.constant = built_in(static_cast<BuiltInMatrix>(step.operands[0])); break;
            case PositionOp::attribute: attribute(step, out); break;
            case PositionOp::pick:
                for (std::size_t i = 0; i < step.components(); ++i)
                    put(out, i, component(values_[step.operands[2 * i]], step.operands[2 * i + 1]));
                break;
            case PositionOp::product: product(step, out); break;
            case PositionOp::inverse: out.constant = inverse(values_[step.operands[0]].constant, step.rows); break;
            default: each_component(step, out); break;
        }
        return true;
    }
    static void attribute(const PositionStep& step, Value& out) {
        for (std::size_t i = 0; i < step.rows; ++i) out.slope[i][i] = 1;
    }
    std::array<float, 16> built_in(BuiltInMatrix which) const {
        std::array<float, 16> out{};
        if (which == BuiltInMatrix::modelview) std::ranges::copy(given_.modelview, out.begin());
        if (which == BuiltInMatrix::projection) std::ranges::copy(given_.projection, out.begin());
        if (which != BuiltInMatrix::modelview_projection) return out;
        for (std::size_t column = 0; column < 4; ++column)
            for (std::size_t row = 0; row < 4; ++row)
                for (std::size_t i = 0; i < 4; ++i)
                    out[4 * column + row] += given_.projection[4 * i + row] * given_.modelview[4 * column + i];
        return out;
    }
    void each_component(const PositionStep& step, Value& out) const {
        const PositionStep &left = program_.steps[step.operands[0]], &right = program_.steps[step.operands[1]];
        const Value &a = values_[step.operands[0]], &b = values_[step.operands[1]];
        for (std::size_t i = 0; i < step.components(); ++i) {
            const Component x = component(a, left.components() == 1 ? 0 : i),
                            y = component(b, right.components() == 1 ? 0 : i);
            if (step.op == PositionOp::add) put(out, i, combine(x, y, std::plus<>()));
            else if (step.op == PositionOp::subtract) put(out, i, combine(x, y, std::minus<>()));
            else if (step.op == PositionOp::multiply) put(out, i, times(x, y));
            else put(out, i, divided(x, y.terms[Component::kConstant]));
        }
    }
    void product(const PositionStep& step, Value& out) const {
        const PositionStep &left = program_.steps[step.operands[0]], &right = program_.steps[step.operands[1]];
        const Value &a = values_[step.operands[0]], &b = values_[step.operands[1]];
        // A vector on the left is a row.
        const bool row_vector = left.columns == 1;
        const std::size_t inner = row_vector ? left.rows : left.columns, rows = row_vector ? 1 : left.rows;
        for (std::size_t column = 0; column < right.columns; ++column)
            for (std::size_t row = 0; row < rows; ++row) {
                Component sum{};
                for (std::size_t i = 0; i < inner; ++i)
                    sum = combine(
                        sum,
                        times(component(a, row_vector ? i : i * rows + row), component(b, column * right.rows + i)),
                        std::plus<>());
                put(out, column * rows + row, sum);
            }
    }

    const PositionProgram& program_;
    const PositionValues& given_;
    std::vector<Value> values_;  ///< by step
};

}  // namespace

bool is_valid(const PositionProgram& program) { return Check(program).run(); }

std::array<float, 16> PositionTransform::matrix() const {
    std::array<float, 16> out = linear;
    for (std::size_t row = 0; row < kVectorComponents; ++row) out[12 + row] += constant[row];
    return out;
}

std::optional<PositionTransform> evaluate(const PositionProgram& program, const PositionValues& values) {
    return Evaluation(program, values).run();
}

LinkedPosition::LinkedPosition(PositionProgram program, std::vector<std::uint32_t> locations)
    : program_(std::move(program)), locations_(std::move(locations)), values_(program_.uniforms.size()) {}

void LinkedPosition::set(std::uint32_t first, std::size_t words_each, std::span<const std::uint32_t> words) {
    for (std::size_t i = 0; i < locations_.size(); ++i) {
        const std::size_t element = locations_[i] - first;
        if (locations_[i] < first || (element + 1) * words_each > words.size()) continue;
        std::vector<float>& value = values_[i];
        value.resize(words_each);
        std::ranges::transform(words.subspan(element * words_each, words_each), value.begin(),
                               [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
        current_ = false;
    }
}

const PositionTransform* LinkedPosition::transform(std::span<const float, 16> modelview,
                                                   std::span<const float, 16> projection) {
    if (!program_.known()) return nullptr;
    if (!current_ || !std::ranges::equal(modelview, modelview_) || !std::ranges::equal(projection, projection_)) {
        const std::vector<std::span<const float>> values(values_.begin(), values_.end());
        transform_ = evaluate(program_, {values, modelview, projection});
        std::ranges::copy(modelview, modelview_.begin());
        std::ranges::copy(projection, projection_.begin());
        current_ = true;
    }
    return transform_ ? &*transform_ : nullptr;
}

}  // namespace wall::glapi
