// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_position.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tileserver/objects/assembly_operands.h"
#include "tileserver/objects/assembly_tokens.h"
#include "tileserver/objects/assembly_values.h"
#include "tileserver/objects/position_builder.h"

namespace wall::tileserver {
namespace {

constexpr std::size_t kLongestSource = std::size_t{128} << 10;

class Recogniser {
public:
    explicit Recogniser(std::string_view source) : tokens_(assembly_tokens(source)) {}

    AssemblyPosition run() {
        at_.take();
        bool invariant = false, other = false;
        at_.take_options(
            [&](std::string_view option) { (option == "ARB_position_invariant" ? invariant : other) = true; });
        if (other) return {false, {}, "an option that is not followed"};
        if (invariant) return invariant_position();
        while (!at_.at_end() && at_.peek() != "END") {
            const std::string_view word = at_.take();
            if (!operands_.declare(word)) execute(word);
        }
        if (!operands_.understood()) return {false, {}, "a declaration that is not understood"};
        return finished(values_.whole(operands_.position()), false);
    }

private:
    AssemblyPosition invariant_position() {
        const auto matrix = builder_.built_in(glapi::BuiltInMatrix::modelview_projection);
        return finished(builder_.product(matrix, builder_.attribute("gl_Vertex", 4)), true);
    }
    AssemblyPosition finished(const PositionValue& position, bool invariant) const {
        AssemblyPosition out{invariant, {}, {}};
        if (const auto why = builder_.finish(position, out.program)) out.reason = describe(*why);
        return out;
    }

    void execute(std::string_view word) {
        const AssemblyTarget target = operands_.take_target();
        AssemblyVector result = result_of(word);
        if (at_.peek() != ";") result = AssemblyValues::unknown(WhyUnknown::not_affine);  // more than was looked at
        at_.skip_statement();
        if (target.variable == nullptr) return;
        for (const unsigned component : target.written) (*target.variable)[component] = result[component];
    }

    AssemblyVector result_of(std::string_view word) {
        if (word == "MOV") return next();
        if (word == "SWZ") return swizzled();
        if (word == "ADD" || word == "SUB") return added(word == "SUB");
        if (word == "MUL" || word == "MAD") return multiplied(word == "MAD");
        if (word == "DP3" || word == "DP4") return dotted(word == "DP3" ? 3 : 4);
        if (word == "DPH") return dotted_homogeneous();
        return AssemblyValues::unknown(WhyUnknown::not_affine);
    }

    /// The next source operand.
    AssemblyVector next() {
        at_.take(",");
        return operands_.take_source();
    }
    static AssemblyVector everywhere(const AssemblyScalar& value) { return {value, value, value, value}; }

    AssemblyVector added(bool subtracted) {
        const AssemblyVector a = next(), b = next();
        AssemblyVector out;
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = values_.sum(a[i], subtracted ? values_.negated(b[i]) : b[i]);
        return out;
    }
    AssemblyVector multiplied(bool and_added) {
        const AssemblyVector a = next(), b = next();
        AssemblyVector out;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = values_.product(a[i], b[i]);
        if (!and_added) return out;
        const AssemblyVector c = next();
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = values_.sum(out[i], c[i]);
        return out;
    }
    AssemblyVector dotted(unsigned components) {
        const AssemblyVector a = next(), b = next();
        return everywhere(values_.dot(a, b, components));
    }
    AssemblyVector dotted_homogeneous() {
        AssemblyVector a = next();
        const AssemblyVector b = next();
        a[3] = values_.constant(1);
        return everywhere(values_.dot(a, b, 4));
    }

    /// "SWZ r, a, x, -y, 0, 1;"
    AssemblyVector swizzled() {
        at_.take(",");
        const AssemblyVector from = operands_.take_base();
        AssemblyVector out;
        for (AssemblyScalar& scalar : out) {
            at_.take(",");
            const bool negative = at_.take("-");
            if (!negative) at_.take("+");
            const std::string_view what = at_.take();
            const std::size_t component = std::string_view("xyzwrgba").find(what);
            if (what == "0" || what == "1") scalar = values_.constant(what == "1" ? 1.0f : 0.0f);
            else if (what.size() == 1 && component != std::string_view::npos) scalar = from[component % 4];
            else return AssemblyValues::unknown(WhyUnknown::not_affine);
            if (negative) scalar = values_.negated(scalar);
        }
        return out;
    }

    const std::vector<AssemblyToken> tokens_;
    AssemblyCursor at_{tokens_};
    PositionBuilder builder_;
    AssemblyValues values_{builder_};
    AssemblyOperands operands_{at_, builder_, values_};
};

}  // namespace

AssemblyPosition recognise_assembly_position(std::string_view source) {
    if (source.size() > kLongestSource) return {false, {}, describe(WhyUnknown::too_long)};
    return Recogniser(source).run();
}

}  // namespace wall::tileserver
