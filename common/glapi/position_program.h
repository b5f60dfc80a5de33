// SPDX-License-Identifier: MIT
// How a vertex shader makes gl_Position of one attribute, where that is an affine function of it: a list of steps that
// a node recognised in the parsed source (tileserver/objects/position_recogniser.h), and which the client and the nodes
// evaluate to a matrix when uniforms or matrices have changed, so that draws with shaders have boxes like those of
// fixed function (DESIGN, section 4, "Shaders and boxes"). It travels with a program's definition and with what linking
// told about it (program_format.h). Pure.
//
// The steps are a list in which each names earlier ones, not a postfix expression: what a shader uses twice is there
// once, so that sixty lines of `p += p;` are sixty steps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wall::glapi {

enum class PositionOp : std::uint8_t {
    constant,   ///< its components, as bits of floats
    uniform,    ///< index in PositionProgram::uniforms
    built_in,   ///< BuiltInMatrix
    attribute,  ///< none; x, y, z and w as far as the shader declares them
    pick,       ///< for each component: a step and a component of it, which is what swizzles and constructors do
    add,        ///< two steps of the same shape, here and in the next three, or one of them is a scalar
    subtract,
    multiply,  ///< component by component
    divide,
    product,  ///< of linear algebra: matrices and vectors, which stand as rows on the left; of two vectors the scalar
    inverse,  ///< of a square matrix
};

/// Of fixed function (OpenGL 2.1, 2.11.2), as GLSL names them.
enum class BuiltInMatrix : std::uint8_t { modelview, projection, modelview_projection };

struct PositionStep {
    PositionOp op = PositionOp::constant;
    std::uint8_t columns = 1, rows = 1;  ///< of its value; components go column by column
    std::vector<std::uint32_t> operands;
    bool operator==(const PositionStep&) const = default;
    std::size_t components() const { return std::size_t{columns} * rows; }
};

/// One element of a uniform of floats.
struct PositionUniform {
    std::string name;  ///< as the program's other ends name it, without "[0]"
    std::uint32_t element = 0;
    bool operator==(const PositionUniform&) const = default;
};

struct PositionProgram {
    std::vector<PositionUniform> uniforms;
    std::string attribute;            ///< "gl_Vertex", or a generic one
    bool depth = true;                ///< false: z is another function, and 0 here
    std::vector<PositionStep> steps;  ///< the last one is the position; none: it was not recognised
    /// Of `uniforms`: the matrix that whoever started the program has named (named_camera.h). It counts where the steps
    /// do not show which is the camera.
    std::optional<std::uint32_t> camera = {};
    bool operator==(const PositionProgram&) const = default;
    bool known() const { return !steps.empty(); }
};

/// Shaders that people write take about ten.
inline constexpr std::size_t kMostPositionSteps = 256;

/// Whether every step has a meaning: operands that are there and of shapes that go together, and nothing that is not
/// affine. One that is not known is valid. To be asked of what comes from elsewhere, before evaluate().
bool is_valid(const PositionProgram& program);

/// What a program's value depends on; all of it must stay while it is used.
struct PositionValues {
    std::span<const std::span<const float>> uniforms;  ///< in the program's order, each column by column
    std::span<const float, 16> modelview, projection;
};

/// gl_Position is `linear` times the attribute (x, y, z, w), and `constant`.
struct PositionTransform {
    std::array<float, 16> linear{};  ///< column by column
    std::array<float, 4> constant{};
    /// Column by column, what `matrix()` would be if nothing had a sign: where matrices nearly cancel each other these
    /// are much larger, and so are the rounding errors of whoever computes it.
    std::array<float, 16> sizes{};
    /// They do not nearly cancel each other.
    bool steady() const;
    /// Multiples of a vertex are the same place, as in fixed function.
    bool homogeneous() const { return constant == std::array<float, 4>{}; }
    /// Of attributes whose w is 1.
    std::array<float, 16> matrix() const;
};

/// Nothing: the program is not known, a uniform has not as many components as the shader takes, or what comes of it is
/// no number. Of a valid program only.
std::optional<PositionTransform> evaluate(const PositionProgram& program, const PositionValues& values);

/// The matrix that everything else is multiplied by last, and that takes part in nothing else: changing it changes what
/// is seen and not what there is.
struct LastMatrix {
    bool built_in = false;      ///< the projection of fixed function
    std::uint32_t uniform = 0;  ///< else: index in PositionProgram::uniforms
    bool named = false;         ///< that uniform, on somebody's word
    bool operator==(const LastMatrix&) const = default;
};
/// As the steps show it; else the one that is named. Nothing: it is made in another way. Of a valid program.
std::optional<LastMatrix> last_matrix(const PositionProgram& program);

/// The position program of a linked program with the values that its uniforms have now; evaluated when it is asked for
/// and something has changed. For one thread at a time.
class LinkedPosition {
public:
    LinkedPosition() = default;
    /// `locations`: of the program's uniforms, in its order, as whoever sets them names them.
    LinkedPosition(PositionProgram program, std::vector<std::uint32_t> locations);

    const PositionProgram& program() const { return program_; }
    const std::vector<std::uint32_t>& locations() const { return locations_; }
    /// The last matrix if it is a uniform, by its location; nothing: it is none, or one that has no value yet.
    struct Camera {
        std::uint32_t location;
        std::span<const float, 16> matrix;
    };
    std::optional<Camera> uniform_camera() const;
    /// That camera is known by its name only.
    bool camera_is_named() const { return last_ && last_->named; }
    /// The last matrix, of vertices in eye space or before; empty: there is none.
    std::span<const float> camera(std::span<const float, 16> projection) const;
    /// Uniforms have values from now on: those with the locations from `first` on, each of `words_each`.
    void set(std::uint32_t first, std::size_t words_each, std::span<const std::uint32_t> words);
    /// Null as evaluate() says. Stays until the next call.
    const PositionTransform* transform(std::span<const float, 16> modelview, std::span<const float, 16> projection);

private:
    PositionProgram program_;
    std::vector<std::uint32_t> locations_;
    std::optional<LastMatrix> last_;
    std::vector<std::vector<float>> values_;  ///< of the uniforms
    std::array<float, 16> modelview_{}, projection_{};
    bool current_ = false;
    std::optional<PositionTransform> transform_;
};

}  // namespace wall::glapi
