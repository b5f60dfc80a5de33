// SPDX-License-Identifier: MIT
#include "tileserver/objects/position_recogniser.h"

#include <initializer_list>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tileserver/objects/lookup_finder.h"
#include "tileserver/objects/position_builder.h"
#include "tileserver/objects/shader_tree.h"
#include "tileserver/objects/shader_variables.h"

namespace wall::tileserver {
namespace {

using glapi::BuiltInMatrix;
using glapi::PositionOp;
using glslang::TIntermAggregate;
using glslang::TIntermBinary;
using glslang::TIntermTyped;
using glslang::TOperator;

constexpr int kDeepest = 200;        ///< expressions and calls within each other
constexpr int kMostNodes = 1 << 16;  ///< of the tree, each as often as it is gone through

/// How a statement ends. Unclear: by a jump that depends on values.
enum class Flow { goes_on, returned, unclear };

class Recogniser {
public:
    /// `any_precision`: qualifiers of precision have no meaning.
    Recogniser(glslang::TIntermediate& tree, bool any_precision)
        : any_precision_(any_precision),
          root_(tree.getTreeRoot() ? tree.getTreeRoot()->getAsAggregate() : nullptr),
          variables_(builder_, any_precision) {
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
        const auto why = builder_.finish(variables_.position(), out.program);
        if (why) out.reason = describe(*why);
        return out;
    }
    /// After run(). Not known: it is no function of one attribute.
    glapi::PositionProgram coordinates(const FoundLookup& lookup) {
        const PositionValue value = variables_.handed_on(lookup.place);
        glapi::PositionProgram out;
        if (value.size() < 2) return out;
        PositionValue whole(1, 4);
        whole[0] = value[0], whole[1] = value[1], whole[2] = number(0)[0], whole[3] = number(1)[0];
        return builder_.finish(whole, out) ? glapi::PositionProgram{} : out;
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
        const auto before = variables_.values();
        nodes_left_ -= static_cast<int>(before.size() / 8);
        const Flow flow = execute(body_of(function));
        if (flow != Flow::unclear) return flow;
        variables_.restore(before);
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
    Flow leave(glslang::TIntermBranch& branch) {
        if (branch.getFlowOp() != glslang::EOpReturn) return Flow::unclear;
        if (branch.getExpression()) result_ = evaluate(branch.getExpression());
        return Flow::returned;
    }
    /// Either side; their values, if they have any, are in result_.
    template <class Follow>
    Flow select(glslang::TIntermSelection& selection, Follow&& follow) {
        evaluate(selection.getCondition());
        auto before = variables_.values();
        const Flow first = follow(selection.getTrueBlock());
        const PositionValue first_result = result_;
        const auto after_first = variables_.take();
        variables_.restore(std::move(before));
        const Flow second = follow(selection.getFalseBlock());
        if (first != second) return Flow::unclear;
        merge(after_first);
        result_ = ShaderVariables::merged(first_result, result_);
        return first;
    }
    void merge(const ShaderVariables::Values& other) {
        nodes_left_ -= static_cast<int>(other.size() / 4);
        variables_.merge(other);
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
        note_effect(place);
        variables_.forget(std::move(place));
    }

    // ---- variables ----

    /// False: it is no place.
    bool find_place(TIntermTyped* node, Place& out) {
        const Visit visit(*this);
        if (!visit) return false;
        if (auto* symbol = node->getAsSymbolNode()) {
            out = Place(*symbol);
            return true;
        }
        auto* part = node->getAsBinaryNode();
        if (part == nullptr || !is_part(part->getOp()) || !find_place(part->getLeft(), out)) return false;
        if (part->getOp() == glslang::EOpIndexIndirect) forget_written(part->getRight());
        out.narrow(*part);
        return true;
    }
    PositionValue read(TIntermTyped* node) {
        Place place;
        return find_place(node, place) ? variables_.read(place, node->getType()) : PositionValue();
    }
    void write(TIntermTyped* node, const PositionValue& value) {
        Place place;
        if (!find_place(node, place)) return;
        note_effect(place);
        variables_.write(place, value);
    }
    /// A draw that chooses a viewport or a layer cannot be left out where it does not show in this one.
    void note_effect(const Place& place) {
        const auto built_in = place.root->getQualifier().builtIn;
        has_effects_ = has_effects_ || built_in == glslang::EbvViewportIndex || built_in == glslang::EbvLayer;
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
            const auto before = variables_.values();
            evaluate(node.getRight());
            merge(before);
            return {};
        }
        const PositionValue right = evaluate(node.getRight());
        return op == glslang::EOpComma ? right : operate(op, left, right);
    }
    PositionValue assign(TIntermBinary& node, const PositionValue& value) {
        write(node.getLeft(), value);
        return value;
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
        return which ? ShaderVariables::part_of(left, *which, node.getType()) : PositionValue();
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
        write(node.getOperand(), after);
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
            write(parameters->getSequence()[i]->getAsTyped(),
                  qualifiers[i] == glslang::EvqOut ? PositionValue() : values[i]);
        const PositionValue outer = std::exchange(result_, {});
        const Flow flow = execute_body(*function);
        const PositionValue result = std::exchange(result_, outer);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (is_written(qualifiers[i]))
                write(arguments[i]->getAsTyped(), read(parameters->getSequence()[i]->getAsTyped()));
        }
        return flow == Flow::unclear ? unknown_of(node.getType(), WhyUnknown::depends_on_flow) : result;
    }
    const bool any_precision_;
    TIntermAggregate* root_;
    std::map<std::string, TIntermAggregate*> functions_;
    PositionBuilder builder_;
    ShaderVariables variables_;
    PositionValue result_;  ///< of the function that is gone through, or of one side of a choice
    bool has_effects_ = false, gave_up_ = false;
    int depth_ = 0, nodes_left_ = kMostNodes;
};

}  // namespace

RecognisedPosition recognise_position(const glapi::ProgramDefinition& definition) {
    if (!definition.feedback.names.empty()) return {{}, "vertices are captured"};
    std::vector<const std::string*> sources, fragment_shaders;
    std::size_t bytes = 0;
    for (const glapi::ShaderSource& shader : definition.shaders) {
        if (shader.type == GL_VERTEX_SHADER) sources.push_back(&shader.source), bytes += shader.source.size();
        else if (shader.type == GL_FRAGMENT_SHADER) fragment_shaders.push_back(&shader.source);
        else return {{}, "another stage moves vertices"};
    }
    if (sources.empty()) return {{}, "no vertex shader"};
    if (bytes > kMostShaderBytes) return {{}, describe(WhyUnknown::too_long)};
    const ParsedShaders parsed(EShLangVertex, sources);
    if (parsed.tree() == nullptr) return {{}, "not parsed"};
    Recogniser recogniser(*parsed.tree(), parsed.any_precision());
    RecognisedPosition out = recogniser.run();
    if (!out.program.known()) return out;
    const std::set<std::string> used_before = used_samplers(*parsed.tree());
    for (const FoundLookup& lookup : find_lookups(fragment_shaders)) {
        if (used_before.contains(lookup.sampler)) continue;
        if (auto coordinates = recogniser.coordinates(lookup); coordinates.known())
            out.lookups.push_back({lookup.sampler, std::move(coordinates)});
    }
    return out;
}

}  // namespace wall::tileserver
