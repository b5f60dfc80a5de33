// SPDX-License-Identifier: MIT
// What a shader's variables hold while it is gone through (position_recogniser.h), gl_Position among them.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tileserver/objects/position_builder.h"
#include "tileserver/objects/shader_tree.h"

namespace wall::tileserver {

inline constexpr const char* kPosition = "gl_Position";

/// A variable, or a part of one.
struct Place {
    std::string variable;       ///< by its number; a part of a structure or an array has its own behind a dot
    std::string path;           ///< the same as OpenGL names a uniform, without `element`
    std::uint32_t element = 0;  ///< the last index of an array
    bool indexed = false;       ///< has such an index
    const glslang::TIntermSymbol* root = nullptr;
    const glslang::TType* type = nullptr;  ///< of the variable
    std::vector<unsigned> components;      ///< that are meant, of a variable of floats
    bool clear = true;                     ///< false: some part of it, known only when the shader runs

    explicit Place(const glslang::TIntermSymbol& symbol);
    Place() = default;
    /// A part of it from now on.
    void narrow(glslang::TIntermBinary& part);
    /// `path` with the element.
    std::string full_path() const { return indexed ? path + "[" + std::to_string(element) + "]" : path; }

private:
    void select(glslang::TIntermBinary& part);
    void enter(glslang::TIntermBinary& part);
    void set_type(const glslang::TType& of);
};

/// A variable, or a part of one, from stage to stage.
struct HandedOn {
    std::string name;                       ///< Place::full_path()
    std::optional<unsigned> location = {};  ///< if the shader gives it one
    auto operator<=>(const HandedOn&) const = default;
    /// Nothing: it is no such one, or in a block.
    static std::optional<HandedOn> of(const Place& place, glslang::TStorageQualifier storage);
};

class ShaderVariables {
public:
    /// `any_precision`: qualifiers of precision have no meaning. The builder outlives it.
    ShaderVariables(PositionBuilder& builder, bool any_precision) : builder_(builder), any_precision_(any_precision) {}

    /// Of that type.
    PositionValue read(const Place& place, const glslang::TType& type);
    /// A value of another shape: nothing is known of the place.
    void write(const Place& place, const PositionValue& value);
    void forget(Place place);
    PositionValue position() const;
    /// What the shader hands on to the next stage by that name; nothing is known of it: no components.
    PositionValue handed_on(const HandedOn& which) const;

    using Values = std::map<std::string, PositionValue>;
    const Values& values() const { return values_; }
    Values take() { return std::move(values_); }
    void restore(Values values) { values_ = std::move(values); }
    /// What holds where either these are so or `other`.
    void merge(const Values& other);
    static PositionValue merged(const PositionValue& a, const PositionValue& b);

    /// Those components of a value.
    static PositionValue part_of(const PositionValue& whole, const std::vector<unsigned>& components,
                                 const glslang::TType& type);

private:
    PositionValue read_whole(const Place& place);
    PositionValue uniform(const Place& place, const PositionValue& unknown);
    void erase_parts(const std::string& whole);

    PositionBuilder& builder_;
    const bool any_precision_;
    Values values_;
    std::map<HandedOn, std::string> handed_on_;  ///< that were written: the variable of each
};

}  // namespace wall::tileserver
