// SPDX-License-Identifier: MIT
#include "tileserver/objects/shader_tree.h"

#include <glslang/Public/ResourceLimits.h>

#include <algorithm>
#include <string_view>

namespace wall::tileserver {

using glslang::TIntermBinary;
using glslang::TIntermTyped;
using glslang::TOperator;

// ---- parsing ----

namespace {

constexpr int kDefaultVersion = 110;  ///< of a shader that names none (GLSL 1.20, 3.3)

/// What goes through a tree takes a part of the stack for each level, also inside glslang, so the text that comes of
/// the macros may not be deeper than this. What nests without a brace and a semicolon is bounded by its length.
constexpr std::size_t kMostStatementBytes = 16 << 10, kMostExpandedBytes = kMostShaderBytes;
constexpr int kMostBraces = 100, kMostElses = 1000;

bool is_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

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

/// The word of a directive, such as `ifdef`; empty: the line has none.
std::string_view directive_of(std::string_view line) {
    const std::size_t hash = line.find_first_not_of(" \t\r");
    if (hash == line.npos || line[hash] != '#') return {};
    const std::string_view rest = line.substr(std::min(line.find_first_not_of(" \t", hash + 1), line.size()));
    return rest.substr(0, static_cast<std::size_t>(std::ranges::find_if_not(rest, is_name) - rest.begin()));
}

/// Whether it begins with a condition of which nothing follows but what is said to be wanted: how many bytes that is,
/// or 0.
std::size_t idle_condition(std::string_view source) {
    if (!directive_of(source.substr(0, source.find('\n'))).starts_with("if")) return 0;
    constexpr int kDeepest = 16;  // so that conditions within conditions are not gone through again and again
    int within = 0;
    for (std::size_t begin = 0; begin < source.size() && within <= kDeepest;) {
        const std::size_t end = std::min(source.find('\n', begin), source.size());
        const std::string_view line = source.substr(begin, end - begin), word = directive_of(line);
        const bool blank = line.find_first_not_of(" \t\r") == line.npos;
        if (line.ends_with('\\') || line.find("/*") != line.npos) return 0;
        if (word.starts_with("if")) ++within;
        else if (word == "endif") --within;
        else if (!blank && word != "extension" && word != "else") return 0;
        begin = end + 1;
        if (within == 0) return std::min(begin, source.size());
    }
    return 0;
}

/// Which extensions there are is the driver's affair, so that conditions on them may come out otherwise here. What is
/// said to be wanted (`#extension`) is no condition.
bool asks_for_extensions(std::string_view source) {
    if (source.find("##") != source.npos) return true;  // could make any name
    bool directive = false;                             // of `#extension`
    for (std::size_t i = 0; i < source.size(); ++i) {
        if (i == 0 || source[i - 1] == '\n')
            while (const std::size_t idle = idle_condition(source.substr(i))) i += idle;
        const std::string_view rest = source.substr(i);
        if (rest.empty()) return false;
        if (rest[0] == '\n') directive = false;
        if (rest[0] == '#')
            directive = rest.substr(std::min(rest.find_first_not_of(" \t", 1), rest.size())).starts_with("extension");
        if (rest.starts_with("//")) i = std::min(source.find('\n', i), source.size()) - 1;
        else if (rest.starts_with("/*")) i = std::min(source.find("*/", i + 2), source.size() - 2) + 1;
        else if (rest.starts_with("GL_") && !directive && (i == 0 || !is_name(source[i - 1]))) {
            const std::size_t end = static_cast<std::size_t>(std::ranges::find_if_not(rest, is_name) - rest.begin());
            if (rest.substr(0, end) != "GL_ES") return true;
        }
    }
    return false;
}

bool is_shallow(glslang::TShader& shader) {
    std::string expanded;
    glslang::TShader::ForbidIncluder nothing;
    return shader.preprocess(GetDefaultResources(), kDefaultVersion, ENoProfile, false, false, EShMsgRelaxedErrors,
                             &expanded, nothing) &&
           is_shallow(expanded);
}

}  // namespace

ParsedShaders::ParsedShaders(EShLanguage stage, const std::vector<const std::string*>& sources) {
    static const bool ready = glslang::InitializeProcess();
    if (ready) parse(stage, sources);
}

void ParsedShaders::parse(EShLanguage stage, const std::vector<const std::string*>& sources) {
    for (const std::string* source : sources) {
        if (asks_for_extensions(*source)) return;
        auto& shader = *shaders_.emplace_back(std::make_unique<glslang::TShader>(stage));
        const char* text = source->data();
        const auto length = static_cast<int>(source->size());
        shader.setStringsWithLengths(&text, &length, 1);
        if (!is_shallow(shader)) return;
        if (!shader.parse(GetDefaultResources(), kDefaultVersion, false, EShMsgRelaxedErrors)) return;
        program_.addShader(&shader);
    }
    if (program_.link(EShMsgRelaxedErrors)) tree_ = program_.getIntermediate(stage);
}

// ---- types ----

bool is_plain_float(const glslang::TType& type) { return type.getBasicType() == glslang::EbtFloat && !type.isArray(); }

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

// ---- operators ----

bool is_part(TOperator op) {
    return op == glslang::EOpIndexDirect || op == glslang::EOpIndexIndirect || op == glslang::EOpIndexDirectStruct ||
           op == glslang::EOpVectorSwizzle;
}

bool is_list(TOperator op) { return op == glslang::EOpSequence || op == glslang::EOpScope || op == glslang::EOpNull; }

std::optional<unsigned> constant_index(TIntermTyped* node) {
    const auto* constant = node->getAsConstantUnion();
    if (constant == nullptr || constant->getConstArray().size() == 0) return std::nullopt;
    const auto& value = constant->getConstArray()[0];
    if (value.getType() == glslang::EbtUint) return value.getUConst();
    if (value.getType() != glslang::EbtInt || value.getIConst() < 0) return std::nullopt;
    return static_cast<unsigned>(value.getIConst());
}

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

bool is_written(glslang::TStorageQualifier qualifier) {
    return qualifier == glslang::EvqOut || qualifier == glslang::EvqInOut;
}

bool writes_arguments(const glslang::TIntermOperator& call) {
    const TOperator op = call.getOp();
    if (op == glslang::EOpModf || op == glslang::EOpFrexp) return true;
    return op >= glslang::EOpEmitVertex && op != glslang::EOpAny && op != glslang::EOpAll && !call.isConstructor() &&
           !(call.isTexture() && !call.isSparseTexture());
}

TOperator operator_of(TOperator assignment) {
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

bool leaves_function(TIntermNode* node) {
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

}  // namespace wall::tileserver
