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
        if (program_.camera && *program_.camera >= program_.uniforms.size()) return false;
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

/// One number as a function of the attribute: its slopes to x, y, z and w, and what it is where the attribute is 0.
struct Component {
    static constexpr std::size_t kConstant = 4;
    std::array<float, 5> terms{};
    std::array<float, 5> sizes{};  ///< what the terms would be if nothing were negative: rounding errors are of these
};

/// Of what does not depend on the attribute.
Component known_component(float value) { return {{0, 0, 0, 0, value}, {0, 0, 0, 0, std::abs(value)}}; }

using Value = std::array<Component, kMostComponents>;

Component added(const Component& a, const Component& b, float sign) {
    Component out;
    for (std::size_t i = 0; i < out.terms.size(); ++i) {
        out.terms[i] = a.terms[i] + sign * b.terms[i];
        out.sizes[i] = a.sizes[i] + b.sizes[i];
    }
    return out;
}

/// One of them does not depend on the vertex, so that its slopes are 0.
Component times(const Component& a, const Component& b) {
    constexpr std::size_t kConstant = Component::kConstant;
    Component out;
    for (std::size_t i = 0; i < kConstant; ++i) {
        out.terms[i] = a.terms[i] * b.terms[kConstant] + a.terms[kConstant] * b.terms[i];
        out.sizes[i] = a.sizes[i] * b.sizes[kConstant] + a.sizes[kConstant] * b.sizes[i];
    }
    out.terms[kConstant] = a.terms[kConstant] * b.terms[kConstant];
    out.sizes[kConstant] = a.sizes[kConstant] * b.sizes[kConstant];
    return out;
}

Component divided(const Component& a, const Component& b) {
    const float by = b.terms[Component::kConstant], error = b.sizes[Component::kConstant] / (by * by);
    Component out;
    for (std::size_t i = 0; i < out.terms.size(); ++i) {
        out.terms[i] = a.terms[i] / by;
        out.sizes[i] = a.sizes[i] * error;
    }
    return out;
}

using Square = std::array<std::array<double, 4>, 4>;  ///< by row

/// By Gauss and Jordan with pivots; of a singular matrix it is no numbers.
Square inverse(const Square& matrix, std::size_t n) {
    double work[4][8] = {};
    for (std::size_t row = 0; row < n; ++row) {
        std::copy_n(matrix[row].begin(), n, work[row]);
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
            for (std::size_t column = 0; column < 2 * n; ++column) work[row][column] -= factor * work[step][column];
        }
    }
    Square out{};
    for (std::size_t row = 0; row < n; ++row) std::copy_n(work[row] + n, n, out[row].begin());
    return out;
}

/// An error E of the matrix becomes inverse * E * inverse.
Value inverse(const Value& matrix, std::size_t n) {
    Square terms{};
    for (std::size_t row = 0; row < n; ++row)
        for (std::size_t column = 0; column < n; ++column)
            terms[row][column] = static_cast<double>(matrix[column * n + row].terms[Component::kConstant]);
    const Square result = inverse(terms, n);
    Value out{};
    for (std::size_t row = 0; row < n; ++row)
        for (std::size_t column = 0; column < n; ++column) {
            double size = 0;
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t k = 0; k < n; ++k)
                    size += std::abs(result[row][i]) *
                            static_cast<double>(matrix[k * n + i].sizes[Component::kConstant]) *
                            std::abs(result[k][column]);
            Component& component = out[column * n + row];
            component.terms[Component::kConstant] = static_cast<float>(result[row][column]);
            component.sizes[Component::kConstant] = static_cast<float>(size);
        }
    return out;
}

class Evaluation {
public:
    Evaluation(const PositionProgram& program, const PositionValues& values) : program_(program), given_(values) {}

    std::optional<PositionTransform> run() {
        if (!program_.known() || given_.uniforms.size() != program_.uniforms.size()) return std::nullopt;
        values_.reserve(program_.steps.size());
        for (const PositionStep& step : program_.steps) {
            Value value{};
            if (!find(step, value)) return std::nullopt;
            values_.push_back(value);
        }
        PositionTransform out;
        bool finite = true;
        for (std::size_t row = 0; row < kVectorComponents; ++row) {
            const Component& c = values_.back()[row];
            for (std::size_t column = 0; column < 4; ++column) {
                out.linear[4 * column + row] = c.terms[column];
                out.sizes[4 * column + row] = c.sizes[column];
            }
            out.constant[row] = c.terms[Component::kConstant];
            out.sizes[12 + row] += c.sizes[Component::kConstant];
            for (std::size_t i = 0; i < c.terms.size(); ++i)
                finite = finite && std::isfinite(c.terms[i]) && std::isfinite(c.sizes[i]);
        }
        return finite ? std::optional(out) : std::nullopt;
    }

private:
    bool find(const PositionStep& step, Value& out) const {
        switch (step.op) {
            case PositionOp::constant:
                std::ranges::transform(step.operands, out.begin(),
                                       [](std::uint32_t bits) { return known_component(std::bit_cast<float>(bits)); });
                break;
            case PositionOp::uniform: {
                const auto given = given_.uniforms[step.operands[0]];
                if (given.size() != step.components()) return false;
                std::ranges::transform(given, out.begin(), known_component);
                break;
            }
            case PositionOp::built_in: out = built_in(static_cast<BuiltInMatrix>(step.operands[0])); break;
            case PositionOp::attribute:
                for (std::size_t i = 0; i < step.rows; ++i) out[i].terms[i] = out[i].sizes[i] = 1;
                break;
            case PositionOp::pick:
                for (std::size_t i = 0; i < step.components(); ++i)
                    out[i] = values_[step.operands[2 * i]][step.operands[2 * i + 1]];
                break;
            case PositionOp::product: product(step, out); break;
            case PositionOp::inverse: out = inverse(values_[step.operands[0]], step.rows); break;
            default: each_component(step, out); break;
        }
        return true;
    }
    Value built_in(BuiltInMatrix which) const {
        Value modelview, projection;
        std::ranges::transform(given_.modelview, modelview.begin(), known_component);
        std::ranges::transform(given_.projection, projection.begin(), known_component);
        if (which == BuiltInMatrix::modelview) return modelview;
        if (which == BuiltInMatrix::projection) return projection;
        Value out{};
        for (std::size_t column = 0; column < 4; ++column)
            for (std::size_t row = 0; row < 4; ++row)
                for (std::size_t i = 0; i < 4; ++i)
                    out[4 * column + row] =
                        added(out[4 * column + row], times(projection[4 * i + row], modelview[4 * column + i]), 1);
        return out;
    }
    void each_component(const PositionStep& step, Value& out) const {
        const PositionStep &left = program_.steps[step.operands[0]], &right = program_.steps[step.operands[1]];
        const Value &a = values_[step.operands[0]], &b = values_[step.operands[1]];
        for (std::size_t i = 0; i < step.components(); ++i) {
            const Component &x = a[left.components() == 1 ? 0 : i], &y = b[right.components() == 1 ? 0 : i];
            if (step.op == PositionOp::add) out[i] = added(x, y, 1);
            else if (step.op == PositionOp::subtract) out[i] = added(x, y, -1);
            else if (step.op == PositionOp::multiply) out[i] = times(x, y);
            else out[i] = divided(x, y);
        }
    }
    void product(const PositionStep& step, Value& out) const {
        const PositionStep &left = program_.steps[step.operands[0]], &right = program_.steps[step.operands[1]];
        const Value &a = values_[step.operands[0]], &b = values_[step.operands[1]];
        // A vector on the left is a row.
        const bool row_vector = left.columns == 1;
        const std::size_t inner = row_vector ? left.rows : left.columns, rows = row_vector ? 1 : left.rows;
        for (std::size_t column = 0; column < right.columns; ++column)
            for (std::size_t row = 0; row < rows; ++row)
                for (std::size_t i = 0; i < inner; ++i)
                    out[column * rows + row] =
                        added(out[column * rows + row],
                              times(a[row_vector ? i : i * rows + row], b[column * right.rows + i]), 1);
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

bool PositionTransform::steady() const {
    constexpr float kSteady = 64;
    float largest = 0;
    for (const float term : matrix()) largest = std::max(largest, std::abs(term));
    return *std::ranges::max_element(sizes) <= kSteady * largest;
}

std::optional<PositionTransform> evaluate(const PositionProgram& program, const PositionValues& values) {
    return Evaluation(program, values).run();
}

namespace {

/// Calls use(step) for each step that this one names, as often as it does.
template <class Use>
void for_each_operand(const PositionStep& step, Use&& use) {
    const bool names_none = step.op == PositionOp::constant || step.op == PositionOp::uniform ||
                            step.op == PositionOp::built_in || step.op == PositionOp::attribute;
    if (names_none) return;
    for (std::size_t i = 0; i < step.operands.size(); i += step.op == PositionOp::pick ? 2 : 1) use(step.operands[i]);
}

std::optional<LastMatrix> shown_by_steps(const PositionProgram& program) {
    const auto& steps = program.steps;
    if (steps.empty()) return std::nullopt;
    const auto is_matrix = [](const PositionStep& step) { return step.columns == 4 && step.rows == 4; };
    std::size_t at = steps.size() - 1;
    while (steps[at].op == PositionOp::product && is_matrix(steps[steps[at].operands[0]])) at = steps[at].operands[0];
    const PositionStep& last = steps[at];
    if (at + 1 == steps.size() || (last.op != PositionOp::uniform && last.op != PositionOp::built_in))
        return std::nullopt;
    const auto same = [&](const PositionStep& step) { return step.op == last.op && step.operands == last.operands; };
    std::size_t uses = 0;
    for (const PositionStep& step : steps)
        for_each_operand(step, [&](std::uint32_t operand) { uses += same(steps[operand]) ? 1 : 0; });
    if (last.op == PositionOp::uniform)
        return uses == 1 ? std::optional(LastMatrix{false, last.operands[0]}) : std::nullopt;
    const bool projects = last.operands[0] != static_cast<std::uint32_t>(BuiltInMatrix::modelview);
    return projects && uses == 1 ? std::optional(LastMatrix{true, 0}) : std::nullopt;
}

}  // namespace

std::optional<LastMatrix> last_matrix(const PositionProgram& program) {
    const auto shown = shown_by_steps(program);
    return shown || !program.camera ? shown : std::optional(LastMatrix{false, *program.camera, true});
}

LinkedPosition::LinkedPosition(PositionProgram program, std::vector<std::uint32_t> locations)
    : program_(std::move(program)),
      locations_(std::move(locations)),
      last_(last_matrix(program_)),
      values_(program_.uniforms.size()) {}

std::optional<LinkedPosition::Camera> LinkedPosition::uniform_camera() const {
    if (!last_ || last_->built_in) return std::nullopt;
    const std::vector<float>& value = values_[last_->uniform];
    if (value.size() != 16) return std::nullopt;
    return Camera{locations_[last_->uniform], std::span(value).first<16>()};
}

std::span<const float> LinkedPosition::camera(std::span<const float, 16> projection) const {
    if (last_ && last_->built_in) return projection;
    const auto uniform = uniform_camera();
    return uniform ? std::span<const float>(uniform->matrix) : std::span<const float>();
}

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
