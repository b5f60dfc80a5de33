// SPDX-License-Identifier: MIT
// Shaders as glslang parses them, and what its tree says of types and operators, for position_recogniser.h and
// lookup_finder.h. Any thread; a tree stays while its ParsedShaders does.
#pragma once

#include <glslang/MachineIndependent/localintermediate.h>
#include <glslang/Public/ShaderLang.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tileserver/objects/position_builder.h"

namespace wall::tileserver {

/// Longer ones are not parsed, all shaders of a stage together.
inline constexpr std::size_t kMostShaderBytes = std::size_t{128} << 10;

/// The shaders of one stage of a program, parsed and linked. glslang is set up at the first use and keeps its tables
/// for as long as the process runs.
class ParsedShaders {
public:
    ParsedShaders(EShLanguage stage, const std::vector<const std::string*>& sources);
    /// Null: they were not parsed, or are deeper than what may be gone through.
    glslang::TIntermediate* tree() const { return tree_; }
    /// Qualifiers of precision have no meaning.
    bool any_precision() const { return tree_->getProfile() != EEsProfile; }

private:
    void parse(EShLanguage stage, const std::vector<const std::string*>& sources);

    std::vector<std::unique_ptr<glslang::TShader>> shaders_;
    glslang::TProgram program_;  // goes before its shaders
    glslang::TIntermediate* tree_ = nullptr;
};

// ---- types ----

/// A number, vector or matrix of floats.
bool is_plain_float(const glslang::TType& type);
/// The value of such a type; of any other, one without components.
PositionValue unknown_of(const glslang::TType& type, WhyUnknown why);
/// A driver may compute with fewer bits.
bool is_low_precision(const glslang::TType& type);

// ---- operators ----

/// A part of a value: an element, a member, a component or several.
bool is_part(glslang::TOperator op);
/// A value that an index may be, known now.
std::optional<unsigned> constant_index(glslang::TIntermTyped* node);
/// Which components of a plain float a part is; nothing: that is not known now.
std::optional<std::vector<unsigned>> selected(glslang::TIntermBinary& part);
/// Statements one after the other.
bool is_list(glslang::TOperator op);
/// `a += b` and the like: `+`.
glslang::TOperator operator_of(glslang::TOperator assignment);
/// Of a parameter, by the function.
bool is_written(glslang::TStorageQualifier qualifier);
/// Of a function of the language. Of those that are not known here it is assumed.
bool writes_arguments(const glslang::TIntermOperator& call);
/// Whether a `return` lies in a statement, or what is no part of a vertex shader.
bool leaves_function(TIntermNode* statement);

}  // namespace wall::tileserver
