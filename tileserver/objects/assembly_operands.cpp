// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_operands.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "common/glapi/assembly_format.h"

namespace wall::tileserver {
namespace {

using glapi::BuiltInMatrix;

/// That are looked at, each as often as it is bound; drivers have some 4000.
constexpr std::size_t kMostParameters = 1 << 13;

/// Of "xyzw" or "rgba"; 4: it is none of these.
unsigned component_called(char letter) {
    const std::size_t place = std::string_view("xyzwrgba").find(letter);
    return place == std::string_view::npos ? 4 : static_cast<unsigned>(place % 4);
}

std::optional<BuiltInMatrix> matrix_called(std::string_view word) {
    if (word == "modelview") return BuiltInMatrix::modelview;
    if (word == "projection") return BuiltInMatrix::projection;
    return word == "mvp" ? std::optional(BuiltInMatrix::modelview_projection) : std::nullopt;
}

bool begins_number(std::string_view token) {
    return !token.empty() && ((token[0] >= '0' && token[0] <= '9') || (token[0] == '.' && token.size() > 1));
}

}  // namespace

// ---- declarations ----

bool AssemblyOperands::declare(std::string_view word) {
    if (word == "TEMP") return declare_variables(Kind::variable), true;
    if (word == "ADDRESS") return declare_variables(Kind::other), true;
    if (word == "ATTRIB") return declare_input(), true;
    if (word == "PARAM") return declare_parameters(), true;
    if (word == "OUTPUT") return declare_output(), true;
    if (word == "ALIAS") return declare_alias(), true;
    return false;
}

void AssemblyOperands::declare_variables(Kind kind) {
    do name(at_.take(), {kind, {AssemblyValues::unknown(WhyUnknown::not_written)}});
    while (at_.take(","));
    at_.skip_statement();
}

void AssemblyOperands::declare_input() {
    const std::string_view text = at_.take();
    at_.take("=");
    name(text, {Kind::parameters, {take_base()}});
    at_.skip_statement();
}

void AssemblyOperands::declare_parameters() {
    const std::string_view text = at_.take();
    const bool array = at_.take("[");
    const auto size = array ? at_.take_index() : std::nullopt;
    if (array) expect("]");
    expect("=");
    Name parameters{Kind::parameters, {}};
    if (!array) parameters.values = {take_base()};
    else if (expect("{")) parameters.values = take_bindings();
    if (array) expect("}");
    understood_ = understood_ && at_.peek() == ";" && (!size || *size == parameters.values.size());
    name(text, std::move(parameters));
    at_.skip_statement();
}

void AssemblyOperands::declare_output() {
    const std::string_view text = at_.take();
    const bool position = at_.take("=") && at_.take("result") && at_.take(".") && at_.take("position");
    name(text, {position ? Kind::position : Kind::other, {}});
    at_.skip_statement();
}

void AssemblyOperands::declare_alias() {
    const std::string_view text = at_.take();
    at_.take("=");
    if (const auto found = names_.find(at_.take()); found != names_.end()) {
        const auto shared = found->second;
        names_[std::string(text)] = shared;
    }
    at_.skip_statement();
}

// ---- what names are bound to ----

/// Of an array, behind its brace.
std::vector<AssemblyVector> AssemblyOperands::take_bindings() {
    std::vector<AssemblyVector> out;
    do {
        for (AssemblyVector& each : take_binding()) out.push_back(std::move(each));
    } while (at_.take(","));
    return out;
}

/// One or several.
std::vector<AssemblyVector> AssemblyOperands::take_binding() {
    if (at_.peek() == "program") return take_parameters();
    if (at_.peek() == "state") return take_state();
    return {take_base()};
}

std::vector<AssemblyVector> AssemblyOperands::take_parameters() {
    at_.take();
    at_.take(".");
    const std::string_view kind = at_.take();
    const bool local = kind == glapi::kLocalParameter;
    if (!local && kind != glapi::kEnvParameter) return {AssemblyValues::unknown(WhyUnknown::other_state)};
    const auto first = at_.take("[") ? at_.take_index() : std::nullopt;
    const auto last = at_.take("..") ? at_.take_index() : first;
    at_.take("]");
    if (!first || !last || *last < *first || *last - *first >= kMostParameters - parameters_) {
        understood_ = false;
        return {};
    }
    parameters_ += *last - *first + 1;
    std::vector<AssemblyVector> out;
    for (std::uint32_t i = *first; i - *first <= *last - *first; ++i)
        out.push_back(AssemblyValues::pick(builder_.uniform(std::string(kind), i, 1, 4), 0, 1, false));
    return out;
}

std::vector<AssemblyVector> AssemblyOperands::take_state() {
    at_.take();
    if (at_.take(".") && at_.take("matrix")) return take_rows(take_matrix());
    skip_binding();
    return {AssemblyValues::unknown(WhyUnknown::other_state)};
}

/// Behind "state.matrix". One that is not followed has unknown rows.
PositionValue AssemblyOperands::take_matrix() {
    at_.take(".");
    const auto which = matrix_called(at_.take());
    const bool first = at_.take_subscript().value_or(0) == 0;
    const PositionValue matrix =
        which && first ? builder_.built_in(*which) : PositionValue(4, 4, WhyUnknown::other_state);
    const std::string_view form = at_.peek() == "." ? at_.peek(1) : std::string_view();
    const bool inverse = form == "inverse" || form == "invtrans",
               transposed = form == "transpose" || form == "invtrans";
    if (inverse || transposed) at_.take(), at_.take();
    const PositionValue inverted = inverse ? builder_.inverse(matrix) : matrix;
    return transposed ? PositionBuilder::transpose(inverted) : inverted;
}

/// All, or those that are named.
std::vector<AssemblyVector> AssemblyOperands::take_rows(const PositionValue& matrix) {
    unsigned first = 0, last = 3;
    if (at_.peek() == "." && at_.peek(1) == "row") {
        at_.take(), at_.take(), at_.take("[");
        first = at_.take_index().value_or(4);
        last = at_.take("..") ? at_.take_index().value_or(4) : first;
        understood_ = expect("]") && understood_ && first <= last && last < 4;
    }
    std::vector<AssemblyVector> out;
    for (unsigned row = first; row <= last && row < 4; ++row)
        out.push_back(AssemblyValues::pick(matrix, row, 4, false));
    return out;
}

/// Behind "vertex".
AssemblyVector AssemblyOperands::take_attribute() {
    at_.take(".");
    const std::string_view word = at_.take();
    const auto index = word == "attrib" ? at_.take_subscript() : std::nullopt;
    if (word == "position" || index == 0u) return AssemblyValues::pick(builder_.attribute("gl_Vertex", 4), 0, 1, true);
    if (index) return AssemblyValues::pick(builder_.attribute(std::to_string(*index), 4), 0, 1, true);
    if (at_.peek() == ".") {  // primary and secondary colours
        const bool colour = at_.peek(1) == "primary" || at_.peek(1) == "secondary";
        if (colour) at_.take(), at_.take();
    }
    at_.take_subscript();
    return AssemblyValues::unknown(WhyUnknown::two_attributes);
}

void AssemblyOperands::skip_binding() {
    for (std::string_view next = at_.peek(); !at_.at_end() && next != "," && next != ";" && next != "}";) {
        at_.take();
        next = at_.peek();
    }
}

// ---- numbers ----

std::optional<AssemblyScalar> AssemblyOperands::take_number() {
    const bool negative = at_.take("-");
    if (!negative) at_.take("+");
    const std::string_view text = at_.take();
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return values_.constant(negative ? -value : value);
}

/// Behind its brace. Components that are not there are 0, 0, 1.
AssemblyVector AssemblyOperands::take_literal() {
    AssemblyVector out;
    for (unsigned i = 0; i < out.size(); ++i) out[i] = values_.constant(i == 3 ? 1.0f : 0.0f);
    for (unsigned i = 0; i < out.size(); ++i) {
        const auto number = take_number();
        if (!number) return AssemblyValues::unknown(WhyUnknown::not_a_float);
        out[i] = *number;
        if (!at_.take(",")) break;
    }
    at_.take("}");
    return out;
}

// ---- operands ----

/// A variable, or a parameter; an element that an address register says is not known.
AssemblyVector AssemblyOperands::take_named(std::string_view text) {
    const auto found = names_.find(text);
    const bool element = at_.peek() == "[";
    const auto index = element ? at_.take_subscript() : std::optional(0u);
    if (!index)
        while (!at_.at_end() && at_.take() != "]") {
        }
    if (found == names_.end() || !index) return AssemblyValues::unknown(WhyUnknown::other_state);
    const Name& known = *found->second;
    if (known.kind == Kind::position) return position_;
    return *index < known.values.size() ? known.values[*index] : AssemblyValues::unknown(WhyUnknown::other_state);
}

AssemblyVector AssemblyOperands::take_base() {
    const auto first_of = [](const std::vector<AssemblyVector>& values) {
        return values.empty() ? AssemblyValues::unknown(WhyUnknown::other_state) : values.front();
    };
    const std::string_view next = at_.peek();
    if (next == "program") return first_of(take_parameters());
    if (next == "state") return first_of(take_state());
    if (next == "-" || next == "+" || begins_number(next)) {
        const auto number = take_number();
        if (!number) return AssemblyValues::unknown(WhyUnknown::not_a_float);
        return {*number, *number, *number, *number};
    }
    at_.take();
    if (next == "{") return take_literal();
    if (next == "vertex") return take_attribute();
    return take_named(next);
}

/// ".x", ".xyz", ".wzyx"; none: there is nothing of the kind, or less than `least`.
std::vector<unsigned> AssemblyOperands::take_components(std::size_t least) {
    std::vector<unsigned> out;
    if (at_.peek() != ".") return out;
    const std::string_view letters = at_.peek(1);
    for (const char letter : letters) out.push_back(component_called(letter));
    if (out.size() < least || out.size() > 4 || std::ranges::find(out, 4u) != out.end()) return {};
    at_.take(), at_.take();
    return out;
}

AssemblyVector AssemblyOperands::take_source() {
    const bool number = begins_number(at_.peek(1));
    const bool negative = !number && at_.take("-");
    if (!number && !negative) at_.take("+");
    const AssemblyVector base = take_base();
    std::vector<unsigned> components = take_components(1);
    if (components.empty()) components = {0, 1, 2, 3};
    if (components.size() == 1) components.assign(4, components[0]);
    if (components.size() != 4) return AssemblyValues::unknown(WhyUnknown::other_state);
    AssemblyVector out;
    for (unsigned i = 0; i < out.size(); ++i)
        out[i] = negative ? values_.negated(base[components[i]]) : base[components[i]];
    return out;
}

AssemblyTarget AssemblyOperands::take_target() {
    AssemblyTarget out;
    const std::string_view text = at_.take();
    if (text == "result") {
        at_.take(".");
        if (at_.take() == "position") out.variable = &position_;
        else
            while (!at_.at_end() && at_.peek() != "," && at_.peek() != ";") at_.take();
    } else if (const auto found = names_.find(text); found != names_.end()) {
        if (found->second->kind == Kind::position) out.variable = &position_;
        if (found->second->kind == Kind::variable) out.variable = &found->second->values.front();
    }
    out.written = take_components(1);
    if (out.written.empty()) out.written = {0, 1, 2, 3};
    return out;
}

}  // namespace wall::tileserver
