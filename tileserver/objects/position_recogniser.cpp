// SPDX-License-Identifier: MIT
#include "tileserver/objects/position_recogniser.h"

#include <glslang/MachineIndependent/localintermediate.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "tileserver/objects/position_builder.h"

namespace wall::tileserver {
namespace {

using glapi::BuiltInMatrix;
using glapi::PositionOp;
using glslang::TIntermAggregate;
using glslang::TIntermBinary;
using glslang::TIntermTyped;
using glslang::TOperator;

constexpr int kDeepest = 200;         ///< expressions and calls within each other
constexpr int kMostNodes = 1 << 16;   ///< of the tree, each as often as it is gone through
constexpr int kDefaultVersion = 110;  ///< of a shader that names none (GLSL 1.20, 3.3)
const std::string kPosition = "gl_Position";

// ---- types ----

bool is_plain_float(const glslang::TType& type) { return type.getBasicType() == glslang::EbtFloat && !type.isArray(); }

/// Of no components where it is no number, vector or matrix of floats.
PositionValue unknown_of(const glslang::TType& type, WhyUnknown why) {
    if (!is_plain_float(type)) return {};
    if (type.isMatrix())
        return {static_cast<unsigned>(type.getMatrixCols()), static_cast<unsigned>(type.getMatrixRows()), why};
    return {1, static_cast<unsigned>(type.getVectorSize()), why};
}

bool is_low_precision(const glslang::TType& type) {
    const auto precision = type.getQualifier().precision;
    return precision == glslang::EpqLow || precision == glslang::EpqMedium;
}

// ---- places ----

/// A variable, or a part of one.
struct Place {
    std::string variable;       ///< as in Variables
    std::string path;           ///< the same as OpenGL names a uniform, without `element`
    std::uint32_t element = 0;  ///< the last index of an array
    bool indexed = false;       ///< has such an index
    const glslang::TIntermSymbol* root = nullptr;
    const glslang::TType* type = nullptr;  ///< of the variable
    std::vector<unsigned> components;      ///< that are meant, of a variable of floats
    bool clear = true;                     ///< false: some part of it, known only when the shader runs

    void set_type(const glslang::TType& of) {
        type = &of;
        const unsigned size = unknown_of(of, WhyUnknown::not_written).size();
        components.resize(size);
        for (unsigned i = 0; i < size; ++i) components[i] = i;
    }
};

/// What variables hold. A part of a structure or an array has a name of its own, which begins with the whole's.
using Variables = std::map<std::string, PositionValue>;

void erase_parts(Variables& variables, const std::string& whole) {
    const std::string begin = whole + ".";
    auto at = variables.lower_bound(begin);
    while (at != variables.end() && at->first.starts_with(begin)) at = variables.erase(at);
}

/// Nothing: no constant.
std::optional<unsigned> constant_index(TIntermTyped* node) {
    const auto* constant = node->getAsConstantUnion();
    if (constant == nullptr || constant->getConstArray().size() == 0) return std::nullopt;
    const auto& value = constant->getConstArray()[0];
    if (value.getType() == glslang::EbtUint) return value.getUConst();
    if (value.getType() != glslang::EbtInt || value.getIConst() < 0) return std::nullopt;
    return static_cast<unsigned>(value.getIConst());
}

/// Which components of `from` an index or a swizzle means, where that is said by constants.
std::optional<std::vector<unsigned>> selected(TIntermBinary& part) {
    const glslang::TType& from = part.getLeft()->getType();
    if (!is_plain_float(from)) return std::nullopt;
    std::vector<unsigned> out;
    if (part.getOp() == glslang::EOpVectorSwizzle) {
        auto* list = part.getRight()->getAsAggregate();
        if (list == nullptr) return std::nullopt;
        for (TIntermNode* item : list->getSequence()) {
            const auto index = constant_index(item->getAsTyped());
            if (!index || *index >= static_cast<unsigned>(from.getVectorSize())) return std::nullopt;
            out.push_back(*index);
        }
        return out;
    }
    const auto index = part.getOp() == glslang::EOpIndexDirect ? constant_index(part.getRight()) : std::nullopt;
    if (!index) return std::nullopt;
    const bool matrix = from.isMatrix();
    const auto count = static_cast<unsigned>(matrix ? from.getMatrixCols() : from.getVectorSize());
    const auto size = static_cast<unsigned>(matrix ? from.getMatrixRows() : 1);
    if (*index >= count) return std::nullopt;
    for (unsigned i = 0; i < size; ++i) out.push_back(*index * size + i);
    return out;
}

// ---- names ----

struct BuiltInName {
    std::string_view name;
    BuiltInMatrix matrix;
};
constexpr BuiltInName kBuiltInNames[] = {
    {"gl_ModelViewMatrix", BuiltInMatrix::modelview},
    {"gl_ProjectionMatrix", BuiltInMatrix::projection},
    {"gl_ModelViewProjectionMatrix", BuiltInMatrix::modelview_projection},
};

bool is_written(glslang::TStorageQualifier qualifier) {
    return qualifier == glslang::EvqOut || qualifier == glslang::EvqInOut;
}

/// Functions of the language. Of those that are not known here it is assumed.
bool writes_arguments(const glslang::TIntermOperator& call) {
    const TOperator op = call.getOp();
    if (op == glslang::EOpModf || op == glslang::EOpFrexp) return true;
    return op >= glslang::EOpEmitVertex && op != glslang::EOpAny && op != glslang::EOpAll && !call.isConstructor() &&
           !(call.isTexture() && !call.isSparseTexture());
}

// ---- going through the shader ----

/// How a statement ends. Unclear: by a jump that depends on values.
enum class Flow { goes_on, returned, unclear };

class Recogniser {
public:
    /// `any_precision`: qualifiers of precision have no meaning.
    Recogniser(glslang::TIntermediate& tree, bool any_precision)
        : any_precision_(any_precision), root_(tree.getTreeRoot() ? tree.getTreeRoot()->getAsAggregate() : nullptr) {
        if (root_ == nullptr) return;
        for (TIntermNode* node : root_->getSequence()) {
            auto* part = node->getAsAggregate();
            if (part && part->getOp() == glslang::EOpFunction) functions_[part->getName().c_str()] = part;
            if (part && part->getOp() == glslang::EOpLinkerObjects) look_at_globals(*part);
        }
    }

    RecognisedPosition run() {
        const auto main = functions_.find("main(");
        if (main == functions_.end()) return {{}, "no main"};
        for (TIntermNode* node : root_->getSequence()) {
            auto* part = node->getAsAggregate();
            if (part && (part->getOp() == glslang::EOpFunction || part->getOp() == glslang::EOpLinkerObjects)) continue;
            execute(node);  // initial values of global variables
        }
        execute_body(*main->second);
        if (gave_up_) return {{}, describe(WhyUnknown::too_long)};
        if (has_effects_) return {{}, "the shader does more than place its vertices"};
        RecognisedPosition out;
        const auto position = variables_.find(kPosition);
        const auto why = position == variables_.end() ? std::optional(WhyUnknown::not_written)
                                                      : builder_.finish(position->second, out.program);
        if (why) out.reason = describe(*why);
        return out;
    }

private:
    /// A draw that writes memory cannot be left out where it does not show.
    void look_at_globals(TIntermAggregate& globals) {
        for (TIntermNode* node : globals.getSequence()) {
            if (node->getAsTyped() == nullptr) continue;
            const glslang::TType& type = node->getAsTyped()->getType();
            has_effects_ = has_effects_ || type.getQualifier().storage == glslang::EvqBuffer ||
                           type.getBasicType() == glslang::EbtAtomicUint ||
                           (type.getBasicType() == glslang::EbtSampler && type.getSampler().isImage());
        }
    }

    /// One more node, within others; false: there are too many, and nothing is recognised.
    class Visit {
    public:
        explicit Visit(Recogniser& of) : of_(of) {
            ++of_.depth_;
            if (--of_.nodes_left_ <= 0 || of_.depth_ > kDeepest) of_.gave_up_ = true;
        }
        ~Visit() { --of_.depth_; }
        Visit(const Visit&) = delete;
        explicit operator bool() const { return !of_.gave_up_; }

    private:
        Recogniser& of_;
    };

    // ---- statements ----

    static TIntermNode* body_of(TIntermAggregate& function) {
        auto& parts = function.getSequence();
        return parts.size() > 1 ? parts[1] : nullptr;
    }
    /// A function with jumps that depend on values may have written anything that it writes.
    Flow execute_body(TIntermAggregate& function) {
        const Variables before = variables_;
        nodes_left_ -= static_cast<int>(before.size() / 8);
        const Flow flow = execute(body_of(function));
        if (flow != Flow::unclear) return flow;
        variables_ = before;
        forget_written(body_of(function));
        return flow;
    }

    Flow execute(TIntermNode* node) {
        const Visit visit(*this);
        if (!visit) return Flow::unclear;
        if (node == nullptr) return Flow::goes_on;
        if (auto* part = node->getAsAggregate(); part && is_list(part->getOp())) {
            for (TIntermNode* statement : part->getSequence())
                if (const Flow flow = execute(statement); flow != Flow::goes_on) return flow;
            return Flow::goes_on;
        }
        if (auto* branch = node->getAsBranchNode()) return leave(*branch);
        if (auto* selection = node->getAsSelectionNode())
            return select(*selection, [&](TIntermNode* side) { return execute(side); });
        if (node->getAsLoopNode() || node->getAsSwitchNode()) {
            if (leaves_function(node)) return Flow::unclear;
            forget_written(node);
            return Flow::goes_on;
        }
        if (auto* typed = node->getAsTyped()) evaluate(typed);
        return Flow::goes_on;
    }
    static bool is_list(TOperator op) {
        return op == glslang::EOpSequence || op == glslang::EOpScope || op == glslang::EOpNull;
    }
    Flow leave(glslang::TIntermBranch& branch) {
        if (branch.getFlowOp() != glslang::EOpReturn) return Flow::unclear;
        if (branch.getExpression()) result_ = evaluate(branch.getExpression());
        return Flow::returned;
    }
    /// Either side; their values, if they have any, are in result_.
    template <class Run>
    Flow select(glslang::TIntermSelection& selection, Run&& run) {
        evaluate(selection.getCondition());
        Variables before = variables_;
        const Flow first = run(selection.getTrueBlock());
        const PositionValue first_result = result_;
        const Variables after_first = std::exchange(variables_, std::move(before));
        const Flow second = run(selection.getFalseBlock());
        if (first != second) return Flow::unclear;
        merge(after_first);
        result_ = merged(first_result, result_);
        return first;
    }
    static PositionValue merged(const PositionValue& a, const PositionValue& b) {
        if (!a.same_shape(b)) return {};
        PositionValue out = a;
        for (unsigned i = 0; i < out.size(); ++i)
            if (!(a[i] == b[i])) out[i] = {-1, static_cast<std::uint8_t>(WhyUnknown::depends_on_flow)};
        return out;
    }
    /// What holds where either this or `other` is so.
    void merge(const Variables& other) {
        nodes_left_ -= static_cast<int>(other.size() / 4);
        for (auto& [name, value] : variables_) {
            const auto found = other.find(name);
            value = found == other.end() ? PositionValue() : merged(found->second, value);
        }
        for (const auto& [name, value] : other) variables_.try_emplace(name);
    }

    // ---- what is not followed ----

    /// Nothing is known afterwards of what a part of the tree may write.
    void forget_written(TIntermNode* node) {
        std::set<TIntermAggregate*> functions;
        forget_written(node, functions);
    }
    void forget_written(TIntermNode* node, std::set<TIntermAggregate*>& functions) {
        const Visit visit(*this);
        if (!visit || node == nullptr) return;
        const auto all = [&](std::initializer_list<TIntermNode*> parts) {
            for (TIntermNode* part : parts) forget_written(part, functions);
        };
        if (auto* binary = node->getAsBinaryNode()) {
            if (binary->modifiesState()) forget(binary->getLeft());
            all({binary->getLeft(), binary->getRight()});
        } else if (auto* unary = node->getAsUnaryNode()) {
            if (unary->modifiesState() || writes_arguments(*unary)) forget(unary->getOperand());
            all({unary->getOperand()});
        } else if (auto* selection = node->getAsSelectionNode()) {
            all({selection->getCondition(), selection->getTrueBlock(), selection->getFalseBlock()});
        } else if (auto* loop = node->getAsLoopNode()) {
            all({loop->getTest(), loop->getBody(), loop->getTerminal()});
        } else if (auto* choice = node->getAsSwitchNode()) {
            all({choice->getCondition(), choice->getBody()});
        } else if (auto* branch = node->getAsBranchNode()) {
            all({branch->getExpression()});
        } else if (auto* aggregate = node->getAsAggregate()) {
            forget_arguments(*aggregate);
            for (TIntermNode* part : aggregate->getSequence()) forget_written(part, functions);
            TIntermAggregate* function = function_of(*aggregate);
            if (function && functions.insert(function).second) forget_written(body_of(*function), functions);
        }
    }
    /// Those that a call may write.
    void forget_arguments(TIntermAggregate& call) {
        if (is_list(call.getOp()) || call.getOp() == glslang::EOpComma) return;
        const bool function = call.getOp() == glslang::EOpFunctionCall;
        if (!function && !writes_arguments(call)) return;
        const auto& qualifiers = call.getQualifierList();
        for (std::size_t i = 0; i < call.getSequence().size(); ++i)
            if (!function || i >= qualifiers.size() || is_written(qualifiers[i]))
                forget(call.getSequence()[i]->getAsTyped());
    }
    void forget(TIntermTyped* target) {
        Place place;
        if (target == nullptr || !find_place(target, place)) return;
        place.clear = false;
        write(place, {});
    }
    /// Whether a `return` lies in a statement, or what is no part of a vertex shader.
    static bool leaves_function(TIntermNode* node) {
        class Returns : public glslang::TIntermTraverser {
        public:
            bool visitBranch(glslang::TVisit, glslang::TIntermBranch* branch) override {
                const TOperator op = branch->getFlowOp();
                found = found || (op != glslang::EOpBreak && op != glslang::EOpContinue && op != glslang::EOpCase &&
                                  op != glslang::EOpDefault);
                return true;
            }
            bool found = false;
        } returns;
        node->traverse(&returns);
        return returns.found;
    }

    // ---- variables ----

    /// False: it is no place.
    bool find_place(TIntermTyped* node, Place& out) {
        const Visit visit(*this);
        if (!visit) return false;
        if (auto* symbol = node->getAsSymbolNode()) {
            out.root = symbol;
            out.path = symbol->getName().c_str();
            out.variable = std::to_string(symbol->getId());
            name_built_in(symbol->getQualifier(), out);
            out.set_type(symbol->getType());
            return true;
        }
        auto* part = node->getAsBinaryNode();
        if (part == nullptr || !is_part(part->getOp()) || !find_place(part->getLeft(), out)) return false;
        if (!part->getRight()->getAsConstantUnion() && part->getOp() == glslang::EOpIndexIndirect)
            forget_written(part->getRight());
        if (!out.clear) return true;
        if (is_plain_float(part->getLeft()->getType())) select_components(*part, out);
        else find_member(*part, out);
        return true;
    }
    static bool is_part(TOperator op) {
        return op == glslang::EOpIndexDirect || op == glslang::EOpIndexIndirect ||
               op == glslang::EOpIndexDirectStruct || op == glslang::EOpVectorSwizzle;
    }
    void name_built_in(const glslang::TQualifier& qualifier, Place& place) {
        if (qualifier.builtIn == glslang::EbvPosition) place.variable = kPosition;
    }
    static void select_components(TIntermBinary& part, Place& out) {
        const auto which = selected(part);
        if (!which) {
            out.clear = false;
            return;
        }
        std::vector<unsigned> components;
        for (const unsigned i : *which) components.push_back(out.components[i]);
        out.components = std::move(components);
    }
    void find_member(TIntermBinary& part, Place& out) {
        const auto index = part.getOp() == glslang::EOpIndexIndirect ? std::nullopt : constant_index(part.getRight());
        if (!index) {
            out.clear = false;
            return;
        }
        if (out.indexed) out.path += "[" + std::to_string(out.element) + "]";
        out.variable += "." + std::to_string(*index);
        out.indexed = part.getOp() == glslang::EOpIndexDirect;
        out.element = out.indexed ? *index : 0;
        const auto* members = out.indexed ? nullptr : part.getLeft()->getType().getStruct();
        if (members && *index < members->size()) {
            const glslang::TType& member = *(*members)[*index].type;
            out.path += std::string(".") + member.getFieldName().c_str();
            name_built_in(member.getQualifier(), out);
        }
        out.set_type(part.getType());
    }

    PositionValue read(TIntermTyped* node) {
        Place place;
        if (!find_place(node, place)) return {};
        if (!place.clear) return unknown_of(node->getType(), WhyUnknown::not_affine);
        return part_of(read_whole(place), place.components, node->getType());
    }
    static PositionValue part_of(const PositionValue& whole, const std::vector<unsigned>& components,
                                 const glslang::TType& type) {
        PositionValue out = unknown_of(type, WhyUnknown::not_a_float);
        if (out.size() != components.size()) return out;
        for (unsigned i = 0; i < out.size(); ++i)
            if (components[i] < whole.size()) out[i] = whole[components[i]];
        return out;
    }
    PositionValue read_whole(const Place& place) {
        const glslang::TType& type = *place.type;
        if (!is_plain_float(type)) return {};
        if (!any_precision_ && is_low_precision(type)) return unknown_of(type, WhyUnknown::not_a_float);
        if (const auto found = variables_.find(place.variable); found != variables_.end()) return found->second;
        const PositionValue unknown = unknown_of(type, WhyUnknown::not_written);
        const glslang::TType& root = place.root->getType();
        const auto storage = root.getQualifier().storage;
        if (storage == glslang::EvqUniform) return uniform(place, unknown);
        const bool whole = place.path == place.root->getName().c_str() && !place.indexed;
        if (storage != glslang::EvqVaryingIn || !whole) return unknown;
        return type.isMatrix() ? unknown_of(type, WhyUnknown::not_affine)
                               : builder_.attribute(place.path, unknown.rows());
    }
    PositionValue uniform(const Place& place, const PositionValue& unknown) {
        const auto because = [&](WhyUnknown why) { return PositionValue(unknown.columns(), unknown.rows(), why); };
        if (place.root->getType().getBasicType() == glslang::EbtBlock) return because(WhyUnknown::in_a_block);
        if (!place.path.starts_with("gl_"))
            return builder_.uniform(place.path, place.element, unknown.columns(), unknown.rows());
        for (const BuiltInName& known : kBuiltInNames) {
            if (!place.path.starts_with(known.name)) continue;
            const std::string_view variant = std::string_view(place.path).substr(known.name.size());
            const PositionValue matrix = builder_.built_in(known.matrix);
            if (variant.empty()) return matrix;
            if (variant == "Transpose") return PositionBuilder::transpose(matrix);
            if (variant == "Inverse") return builder_.inverse(matrix);
            if (variant == "InverseTranspose") return PositionBuilder::transpose(builder_.inverse(matrix));
        }
        return because(WhyUnknown::other_state);
    }

    void write(const Place& place, const PositionValue& value) {
        const auto built_in = place.root->getQualifier().builtIn;
        has_effects_ = has_effects_ || built_in == glslang::EbvViewportIndex || built_in == glslang::EbvLayer;
        if (place.type->isStruct() || place.type->isArray()) erase_parts(variables_, place.variable);
        if (!is_plain_float(*place.type)) return;
        PositionValue whole = unknown_of(*place.type, WhyUnknown::depends_on_flow);
        if (place.clear) {
            if (const auto found = variables_.find(place.variable);
                found != variables_.end() && found->second.same_shape(whole))
                whole = found->second;
            else whole = unknown_of(*place.type, WhyUnknown::not_written);
            for (unsigned i = 0; i < place.components.size(); ++i)
                whole[place.components[i]] =
                    i < value.size() ? value[i]
                                     : PositionValue::Component{-1, static_cast<std::uint8_t>(WhyUnknown::not_a_float)};
        }
        variables_[place.variable] = whole;
    }

    // ---- expressions ----

    /// Of the shape of its type, whatever is known of it.
    PositionValue evaluate(TIntermTyped* node) {
        const Visit visit(*this);
        if (!visit) return unknown_of(node->getType(), WhyUnknown::too_long);
        PositionValue unknown = unknown_of(node->getType(), WhyUnknown::not_affine);
        PositionValue value = value_of(node);
        if (!value.same_shape(unknown)) return unknown;
        const bool exact = any_precision_ || node->getAsConstantUnion() || !is_low_precision(node->getType());
        return exact ? value : unknown_of(node->getType(), WhyUnknown::not_a_float);
    }
    PositionValue value_of(TIntermTyped* node) {
        if (auto* constant = node->getAsConstantUnion()) return constant_value(*constant);
        if (node->getAsSymbolNode()) return read(node);
        if (auto* selection = node->getAsSelectionNode()) return choice(*selection);
        if (auto* binary = node->getAsBinaryNode()) return binary_value(*binary);
        if (auto* unary = node->getAsUnaryNode()) return unary_value(*unary);
        if (auto* aggregate = node->getAsAggregate()) return aggregate_value(*aggregate);
        forget_written(node);
        return {};
    }
    PositionValue constant_value(glslang::TIntermConstantUnion& node) {
        PositionValue shape = unknown_of(node.getType(), WhyUnknown::not_a_float);
        const auto& constants = node.getConstArray();
        if (shape.size() == 0 || constants.size() != static_cast<int>(shape.size())) return shape;
        std::vector<float> components;
        for (int i = 0; i < constants.size(); ++i) components.push_back(static_cast<float>(constants[i].getDConst()));
        return builder_.constant(shape.columns(), shape.rows(), components);
    }
    PositionValue number(float value) { return builder_.constant(1, 1, std::span(&value, 1)); }
    PositionValue choice(glslang::TIntermSelection& selection) {
        const PositionValue outer = result_;
        select(selection, [&](TIntermNode* side) {
            result_ = side && side->getAsTyped() ? evaluate(side->getAsTyped()) : PositionValue();
            return Flow::goes_on;
        });
        return std::exchange(result_, outer);
    }

    PositionValue binary_value(TIntermBinary& node) {
        const TOperator op = node.getOp();
        if (op == glslang::EOpAssign) return assign(node, evaluate(node.getRight()));
        if (node.modifiesState()) {
            const PositionValue right = evaluate(node.getRight()), left = read(node.getLeft());
            return assign(node, operate(operator_of(op), left, right));
        }
        if (is_part(op)) return part_value(node);
        const PositionValue left = evaluate(node.getLeft());
        if (op == glslang::EOpLogicalAnd || op == glslang::EOpLogicalOr) {
            const Variables before = variables_;
            evaluate(node.getRight());
            merge(before);
            return {};
        }
        const PositionValue right = evaluate(node.getRight());
        return op == glslang::EOpComma ? right : operate(op, left, right);
    }
    PositionValue assign(TIntermBinary& node, const PositionValue& value) {
        Place place;
        if (find_place(node.getLeft(), place)) write(place, value);
        return value;
    }
    static TOperator operator_of(TOperator assignment) {
        switch (assignment) {
            case glslang::EOpAddAssign: return glslang::EOpAdd;
            case glslang::EOpSubAssign: return glslang::EOpSub;
            case glslang::EOpMulAssign: return glslang::EOpMul;
            case glslang::EOpDivAssign: return glslang::EOpDiv;
            case glslang::EOpVectorTimesScalarAssign: return glslang::EOpVectorTimesScalar;
            case glslang::EOpMatrixTimesScalarAssign: return glslang::EOpMatrixTimesScalar;
            case glslang::EOpVectorTimesMatrixAssign: return glslang::EOpVectorTimesMatrix;
            case glslang::EOpMatrixTimesMatrixAssign: return glslang::EOpMatrixTimesMatrix;
            default: return glslang::EOpNull;
        }
    }
    PositionValue operate(TOperator op, const PositionValue& a, const PositionValue& b) {
        switch (op) {
            case glslang::EOpAdd: return builder_.each(PositionOp::add, a, b);
            case glslang::EOpSub: return builder_.each(PositionOp::subtract, a, b);
            case glslang::EOpDiv: return builder_.each(PositionOp::divide, a, b);
            case glslang::EOpMul:
            case glslang::EOpVectorTimesScalar:
            case glslang::EOpMatrixTimesScalar: return builder_.each(PositionOp::multiply, a, b);
            case glslang::EOpVectorTimesMatrix:
            case glslang::EOpMatrixTimesVector:
            case glslang::EOpMatrixTimesMatrix:
            case glslang::EOpDot: return builder_.product(a, b);
            default: return {};
        }
    }
    PositionValue part_value(TIntermBinary& node) {
        if (is_place(&node)) return read(&node);
        const PositionValue left = evaluate(node.getLeft());
        const auto which = selected(node);
        if (!which) forget_written(node.getRight());
        return which ? part_of(left, *which, node.getType()) : PositionValue();
    }
    /// Whether it is a part of a variable, not of what an expression gives.
    static bool is_place(TIntermTyped* node) {
        for (auto* part = node->getAsBinaryNode(); part && is_part(part->getOp()); part = node->getAsBinaryNode())
            node = part->getLeft();
        return node->getAsSymbolNode() != nullptr;
    }

    PositionValue unary_value(glslang::TIntermUnary& node) {
        const PositionValue operand = evaluate(node.getOperand());
        switch (node.getOp()) {
            case glslang::EOpNegative: return builder_.each(PositionOp::multiply, operand, number(-1));
            case glslang::EOpTranspose: return PositionBuilder::transpose(operand);
            case glslang::EOpMatrixInverse: return builder_.inverse(operand);
            case glslang::EOpPreIncrement:
            case glslang::EOpPostIncrement: return step_by(node, operand, 1);
            case glslang::EOpPreDecrement:
            case glslang::EOpPostDecrement: return step_by(node, operand, -1);
            default:
                if (node.isConstructor()) return construct(node.getType(), {operand});
                if (writes_arguments(node)) forget(node.getOperand());
                return {};
        }
    }
    PositionValue step_by(glslang::TIntermUnary& node, const PositionValue& before, float by) {
        const PositionValue after = builder_.each(PositionOp::add, before, number(by));
        Place place;
        if (find_place(node.getOperand(), place)) write(place, after);
        const bool gives_before =
            node.getOp() == glslang::EOpPostIncrement || node.getOp() == glslang::EOpPostDecrement;
        return gives_before ? before : after;
    }

    PositionValue aggregate_value(TIntermAggregate& node) {
        if (node.getOp() == glslang::EOpFunctionCall) return call(node);
        std::vector<PositionValue> arguments;
        for (TIntermNode* part : node.getSequence())
            arguments.push_back(part->getAsTyped() ? evaluate(part->getAsTyped()) : PositionValue());
        if (node.isConstructor()) return construct(node.getType(), arguments);
        forget_arguments(node);
        const std::size_t count = arguments.size();
        switch (node.getOp()) {
            case glslang::EOpComma: return count == 0 ? PositionValue() : arguments.back();
            case glslang::EOpFtransform:
                return builder_.product(builder_.built_in(BuiltInMatrix::modelview_projection),
                                        builder_.attribute("gl_Vertex", 4));
            case glslang::EOpMix:
                if (count != 3) return {};
                return builder_.each(
                    PositionOp::add, arguments[0],
                    builder_.each(PositionOp::multiply, builder_.each(PositionOp::subtract, arguments[1], arguments[0]),
                                  arguments[2]));
            case glslang::EOpFma:
                if (count != 3) return {};
                return builder_.each(PositionOp::add, builder_.each(PositionOp::multiply, arguments[0], arguments[1]),
                                     arguments[2]);
            case glslang::EOpCross: return count == 2 ? cross(arguments[0], arguments[1]) : PositionValue();
            default: return count == 2 ? operate(node.getOp(), arguments[0], arguments[1]) : PositionValue();
        }
    }
    PositionValue cross(const PositionValue& a, const PositionValue& b) {
        if (a.size() != 3 || b.size() != 3) return {};
        const auto turned = [](const PositionValue& v, unsigned by) {
            PositionValue out = v;
            for (unsigned i = 0; i < 3; ++i) out[i] = v[(i + by) % 3];
            return out;
        };
        return builder_.each(PositionOp::subtract, builder_.each(PositionOp::multiply, turned(a, 1), turned(b, 2)),
                             builder_.each(PositionOp::multiply, turned(a, 2), turned(b, 1)));
    }
    /// GLSL 3.30, 5.4.2.
    PositionValue construct(const glslang::TType& type, const std::vector<PositionValue>& arguments) {
        PositionValue out = unknown_of(type, WhyUnknown::not_a_float);
        if (out.size() == 0 || arguments.empty()) return out;
        const PositionValue& first = arguments.front();
        const bool alone = arguments.size() == 1, matrix = type.isMatrix();
        if (alone && matrix && (first.scalar() || first.columns() > 1)) return construct_matrix(out, first);
        unsigned filled = 0;
        for (const PositionValue& argument : arguments) {
            if (argument.size() == 0) return unknown_of(type, WhyUnknown::not_a_float);
            for (unsigned i = 0; i < argument.size() && filled < out.size(); ++i) out[filled++] = argument[i];
        }
        for (; alone && first.scalar() && filled < out.size(); ++filled) out[filled] = first[0];
        return out;
    }
    /// A scalar is its diagonal; of another matrix it has what both have, else of the identity.
    PositionValue construct_matrix(PositionValue out, const PositionValue& from) {
        for (unsigned column = 0; column < out.columns(); ++column)
            for (unsigned row = 0; row < out.rows(); ++row) {
                auto& component = out[column * out.rows() + row];
                if (from.scalar()) component = column == row ? from[0] : number(0)[0];
                else if (column < from.columns() && row < from.rows()) component = from[column * from.rows() + row];
                else component = number(column == row ? 1 : 0)[0];
            }
        return out;
    }

    // ---- functions of the shader ----

    TIntermAggregate* function_of(TIntermAggregate& call) const {
        if (call.getOp() != glslang::EOpFunctionCall) return nullptr;
        const auto found = functions_.find(call.getName().c_str());
        return found == functions_.end() ? nullptr : found->second;
    }
    PositionValue call(TIntermAggregate& node) {
        const auto& arguments = node.getSequence();
        const auto& qualifiers = node.getQualifierList();
        TIntermAggregate* function = function_of(node);
        auto* parameters = function ? function->getSequence()[0]->getAsAggregate() : nullptr;
        if (parameters == nullptr || parameters->getSequence().size() != arguments.size() ||
            qualifiers.size() != arguments.size()) {
            forget_written(&node);
            return {};
        }
        std::vector<PositionValue> values;
        for (TIntermNode* argument : arguments) values.push_back(evaluate(argument->getAsTyped()));
        for (std::size_t i = 0; i < values.size(); ++i)
            set_parameter(parameters->getSequence()[i], qualifiers[i] == glslang::EvqOut ? PositionValue() : values[i]);
        const PositionValue outer = std::exchange(result_, {});
        const Flow flow = execute_body(*function);
        const PositionValue result = std::exchange(result_, outer);
        for (std::size_t i = 0; i < values.size(); ++i) {
            Place place;
            if (!is_written(qualifiers[i]) || !find_place(arguments[i]->getAsTyped(), place)) continue;
            write(place, read(parameters->getSequence()[i]->getAsTyped()));
        }
        return flow == Flow::unclear ? unknown_of(node.getType(), WhyUnknown::depends_on_flow) : result;
    }
    void set_parameter(TIntermNode* parameter, const PositionValue& value) {
        Place place;
        if (parameter->getAsTyped() && find_place(parameter->getAsTyped(), place)) write(place, value);
    }

    bool any_precision_;
    TIntermAggregate* root_;
    std::map<std::string, TIntermAggregate*> functions_;
    PositionBuilder builder_;
    Variables variables_;
    PositionValue result_;  ///< of the function that is gone through, or of one side of a choice
    bool has_effects_ = false, gave_up_ = false;
    int depth_ = 0, nodes_left_ = kMostNodes;
};

/// What goes through a tree takes a part of the stack for each level, also inside glslang, so the text that comes of
/// the macros may not be deeper than this. What nests without a brace and a semicolon is bounded by its length.
constexpr std::size_t kMostStatementBytes = 16 << 10, kMostExpandedBytes = kMostShaderBytes;
constexpr int kMostBraces = 100, kMostElses = 1000;

bool is_shallow(std::string_view expanded) {
    std::size_t statement = 0;
    int braces = 0, elses = 0;
    for (std::size_t i = 0; i < expanded.size(); ++i) {
        const char c = expanded[i];
        braces += c == '{' ? 1 : c == '}' ? -1 : 0;
        elses += expanded.substr(i, 4) == "else" ? 1 : 0;
        statement = c == ';' || c == '{' || c == '}' ? 0 : statement + 1;
        if (statement > kMostStatementBytes || braces > kMostBraces || elses > kMostElses) return false;
    }
    return expanded.size() <= kMostExpandedBytes;
}

bool is_shallow(glslang::TShader& shader) {
    std::string expanded;
    glslang::TShader::ForbidIncluder nothing;
    return shader.preprocess(GetDefaultResources(), kDefaultVersion, ENoProfile, false, false, EShMsgRelaxedErrors,
                             &expanded, nothing) &&
           is_shallow(expanded);
}

/// A program's vertex shaders, parsed and linked; null and a reason, if that did not work.
class ParsedShaders {
public:
    explicit ParsedShaders(const std::vector<const std::string*>& sources) {
        for (const std::string* source : sources) {
            auto& shader = *shaders_.emplace_back(std::make_unique<glslang::TShader>(EShLangVertex));
            const char* text = source->data();
            const auto length = static_cast<int>(source->size());
            shader.setStringsWithLengths(&text, &length, 1);
            if (!is_shallow(shader)) return;
            if (!shader.parse(GetDefaultResources(), kDefaultVersion, false, EShMsgRelaxedErrors)) return;
            program_.addShader(&shader);
        }
        if (program_.link(EShMsgRelaxedErrors)) tree_ = program_.getIntermediate(EShLangVertex);
    }
    glslang::TIntermediate* tree() const { return tree_; }

private:
    std::vector<std::unique_ptr<glslang::TShader>> shaders_;
    glslang::TProgram program_;  // goes before its shaders
    glslang::TIntermediate* tree_ = nullptr;
};

}  // namespace

RecognisedPosition recognise_position(const glapi::ProgramDefinition& definition) {
    if (!definition.feedback.names.empty()) return {{}, "vertices are captured"};
    std::vector<const std::string*> sources;
    std::size_t bytes = 0;
    for (const glapi::ShaderSource& shader : definition.shaders) {
        if (shader.type == GL_VERTEX_SHADER) sources.push_back(&shader.source), bytes += shader.source.size();
        else if (shader.type != GL_FRAGMENT_SHADER) return {{}, "another stage moves vertices"};
    }
    if (sources.empty()) return {{}, "no vertex shader"};
    if (bytes > kMostShaderBytes) return {{}, describe(WhyUnknown::too_long)};
    static const bool ready = glslang::InitializeProcess();  // for good: it keeps the tables of each version
    if (!ready) return {{}, "glslang does not start"};
    const ParsedShaders parsed(sources);
    if (parsed.tree() == nullptr) return {{}, "not parsed"};
    return Recogniser(*parsed.tree(), parsed.tree()->getProfile() != EEsProfile).run();
}

}  // namespace wall::tileserver
