// SPDX-License-Identifier: MIT
// The matrix commands, computed here and sent as results (DESIGN, section 4). Every product and inverse has the float
// operations of Mesa's own fixed function, in their order, so that a program's pixels are the same on a tile as in a
// window. Pure; any thread.
#pragma once

#include <array>
#include <cstdint>

#include "common/glstate/modelview.h"

namespace wall::client {

using glstate::kIdentity;
using glstate::Mat4;
using glstate::Vec3;
using glstate::Vec4;

/// What is known of a matrix from how it was made, as bits. It selects among ways to multiply and to invert that differ
/// in the last bit, so it is kept by Mesa's rules (m_matrix.c), even the odd one that glLoadIdentity forgets nothing.
namespace form {
inline constexpr std::uint32_t kIdentity = 0, kGeneral = 1, kRotation = 2, kTranslation = 4, kUniformScale = 8,
                               kGeneralScale = 16, kGeneral3d = 32, kPerspective = 64;
inline constexpr std::uint32_t kUnknown = 0x200;  ///< to be found out from the values
inline constexpr std::uint32_t kAffine = kRotation | kTranslation | kUniformScale | kGeneralScale | kGeneral3d;
}  // namespace form

/// How a matrix came about: an earlier one whose form its values tell, and the steps from there.
struct MatrixOrigin {
    static constexpr std::size_t kMostSteps = glstate::el::modelview_step::count;
    bool known = true;
    Mat4 base = kIdentity;
    std::array<glstate::ModelviewStep, kMostSteps> steps{};
    std::size_t count = 0;
};

/// A matrix (column major) and its form.
struct FormedMatrix {
    Mat4 m = kIdentity;
    std::uint32_t form = form::kIdentity;
    MatrixOrigin origin{};
};

void load(FormedMatrix& matrix, const Mat4& values);
void load_identity(FormedMatrix& matrix);
void multiply(FormedMatrix& matrix, const Mat4& right);
void rotate(FormedMatrix& matrix, float degrees, float x, float y, float z);
void translate(FormedMatrix& matrix, float x, float y, float z);
void scale(FormedMatrix& matrix, float x, float y, float z);
void frustum(FormedMatrix& matrix, float left, float right, float bottom, float top, float near, float far);
void ortho(FormedMatrix& matrix, float left, float right, float bottom, float top, float near, float far);

/// Determines an unknown form, as drawing and glPushMatrix do.
void determine_form(FormedMatrix& matrix);
/// Determines the form; a singular matrix gives the identity.
Mat4 inverse(FormedMatrix& matrix);
Mat4 transposed(const Mat4& matrix);

/// Whether a driver that is given only the values would invert them to other bits.
bool needs_origin(const FormedMatrix& matrix);
/// Describes the origin of the modelview matrix `matrix` in a state. False if it is not known.
bool describe_origin(const FormedMatrix& matrix, glstate::ModelviewOrigin& out);

/// matrix * point.
Vec4 transform_point(const Mat4& matrix, const Vec4& point);
/// The upper left 3x3 of matrix * direction.
Vec3 transform_direction(const Mat4& matrix, const Vec4& direction);
/// plane * matrix, a row vector: with an inverse it carries plane equations along.
Vec4 transform_plane(const Vec4& plane, const Mat4& matrix);

}  // namespace wall::client
