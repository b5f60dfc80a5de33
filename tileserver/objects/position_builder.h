// SPDX-License-Identifier: MIT
// Makes a position program (common/glapi/position_program.h) from what a shader does, operation by operation. A value
// knows of each of its components where it comes from, so that swizzles, constructors and writes to components cost
// nothing, and what is not known of one component spoils no other. Equal steps are one step, so that what two branches
// do alike is recognised as equal. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "common/glapi/position_program.h"

namespace wall::tileserver {

/// Why a component is not known.
enum class WhyUnknown : std::uint8_t {
    not_written,
    not_affine,       ///< the vertex multiplied by itself, or a function that is not followed
    two_attributes,   ///< a second attribute has a part in it
    depends_on_flow,  ///< branches or loops make different values of it
    not_a_float,      ///< or of a precision that the driver may choose, or not a plain number, vector or matrix
    in_a_block,       ///< a uniform of a block
    other_state,      ///< of fixed function that is not followed
    too_long,
};
const char* describe(WhyUnknown why);

/// A scalar, vector or matrix of floats while the shader is gone through.
class PositionValue {
public:
    struct Component {
        std::int32_t step = -1;  ///< below 0: not known
        std::uint8_t index = 0;  ///< component of that step; else WhyUnknown
        bool operator==(const Component&) const = default;
    };
    PositionValue() = default;  ///< of something that is no float: no components
    PositionValue(unsigned columns, unsigned rows, WhyUnknown why = WhyUnknown::not_written);

    unsigned columns() const { return columns_; }
    unsigned rows() const { return rows_; }
    unsigned size() const { return columns_ * rows_; }
    bool scalar() const { return size() == 1; }
    bool same_shape(const PositionValue& other) const { return columns_ == other.columns_ && rows_ == other.rows_; }
    Component& operator[](unsigned i) { return components_[i]; }
    const Component& operator[](unsigned i) const { return components_[i]; }
    /// The first reason; nothing: all of it is known.
    std::optional<WhyUnknown> unknown() const;
    bool operator==(const PositionValue&) const = default;

private:
    std::uint8_t columns_ = 0, rows_ = 0;
    std::array<Component, 16> components_{};
};

class PositionBuilder {
public:
    using Op = glapi::PositionOp;

    PositionValue constant(unsigned columns, unsigned rows, std::span<const float> components);
    PositionValue uniform(const std::string& name, std::uint32_t element, unsigned columns, unsigned rows);
    PositionValue built_in(glapi::BuiltInMatrix which);
    /// A vector of so many components.
    PositionValue attribute(const std::string& name, unsigned rows);
    /// Component by component; one of them may be a scalar. Not known where it would not be affine.
    PositionValue each(Op op, const PositionValue& a, const PositionValue& b);
    /// Of linear algebra, as glapi::PositionOp::product.
    PositionValue product(const PositionValue& a, const PositionValue& b);
    PositionValue inverse(const PositionValue& matrix);
    static PositionValue transpose(const PositionValue& matrix);

    /// Drops what the position does not need. An error: why it is not known.
    std::optional<WhyUnknown> finish(const PositionValue& position, glapi::PositionProgram& out) const;

private:
    static constexpr std::int32_t kNoAttribute = -1;
    struct Step {
        glapi::PositionStep step;
        std::int32_t attribute = kNoAttribute;  ///< that it depends on, of attributes_
    };
    PositionValue value_of(glapi::PositionStep step, std::int32_t attribute);
    std::int32_t add(glapi::PositionStep step, std::int32_t attribute);
    /// The step that has all of a value, which is known; below 0: there are too many.
    std::int32_t step_of(const PositionValue& value);
    std::int32_t attribute_of(const PositionValue& value) const;
    /// The attribute that either depends on; an error: why the operation is not followed.
    std::optional<WhyUnknown> depend(Op op, const PositionValue& a, const PositionValue& b,
                                     std::int32_t& attribute) const;

    using Key = std::tuple<Op, unsigned, std::vector<std::uint32_t>>;
    std::vector<Step> steps_;
    std::map<Key, std::int32_t> known_;
    std::vector<glapi::PositionUniform> uniforms_;
    std::vector<std::string> attributes_;
};

}  // namespace wall::tileserver
